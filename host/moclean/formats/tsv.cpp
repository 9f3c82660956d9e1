#include "moclean/formats/tsv.hpp"

#include "moclean/formats/new_table.hpp"
#include "moclean/formats/table_document.hpp"

namespace moclean {
namespace {

constexpr std::string_view tsv_extension = ".tsv", txt_extension = ".txt";

Recording read_tsv(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions& options) {
  return read_table(content, file, options, tsv_extension);
}

Recording read_txt(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions& options) {
  return read_table(content, file, options, txt_extension);
}

void write_text(AtomicFile& file, const Recording& recording, std::string_view extension) {
  if (const TableDocument* const document = table_of(recording, extension))
    write_table(file, *document, recording);
  else
    write_new_table(file, recording, '\t');
}

void write_tsv(AtomicFile& file, const Recording& recording) {
  write_text(file, recording, tsv_extension);
}

void write_txt(AtomicFile& file, const Recording& recording) {
  write_text(file, recording, txt_extension);
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

constinit const Format txt_format = {
    .name = "TXT",
    .extension = txt_extension,
    .notes =
        "tables of QTM, Nexus and `numpy.savetxt`, separated by tabs, commas, semicolons or "
        "blanks; in folders they are left out",
    .content = {.names = true, .frame_rate = true, .unit = true, .up = true, .gaps = true},
    .read = read_txt,
    .write = write_txt,
};

}  // namespace moclean
