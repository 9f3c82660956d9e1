#include "moclean/formats/tsv.hpp"

#include "moclean/formats/new_table.hpp"
#include "moclean/formats/table_document.hpp"

namespace moclean {
namespace {

constexpr std::string_view tsv_extension = ".tsv";

Recording read_tsv(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions& options) {
  return read_table(content, file, options, tsv_extension);
}

void write_tsv(AtomicFile& file, const Recording& recording) {
  if (const TableDocument* const document = table_of(recording, tsv_extension))
    write_table(file, *document, recording);
  else
    write_new_table(file, recording, '\t');
}

}  // namespace

constinit const Format tsv_format = {
    .name = "TSV",
    .extension = tsv_extension,
    .notes = "of QTM (3D), and tables as CSV; all but the samples is kept",
    .content = {.names = true, .frame_rate = true, .unit = true, .up = true, .gaps = true},
    .read = read_tsv,
    .write = write_tsv,
};

}  // namespace moclean
