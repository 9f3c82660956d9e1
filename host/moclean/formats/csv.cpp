#include "moclean/formats/csv.hpp"

#include "moclean/formats/new_table.hpp"
#include "moclean/formats/table_document.hpp"

namespace moclean {
namespace {

constexpr std::string_view csv_extension = ".csv";

}  // namespace

Recording parse_csv(std::string_view text, const std::filesystem::path& file,
                    const ReadOptions& options) {
  return read_table(text, file, options, csv_extension);
}

void write_csv(AtomicFile& file, const Recording& recording) {
  if (const TableDocument* const document = table_of(recording, csv_extension))
    write_table(file, *document, recording);
  else
    write_new_table(file, recording, ',');
}

constinit const Format csv_format = {
    .name = "CSV",
    .extension = csv_extension,
    .notes =
        "names in the first line, `# frame_rate: HZ` or a time column; Motive, Nexus, DeepLabCut "
        "and "
        "Anipose too; all but the samples is kept",
    .content = {.names = true, .frame_rate = true, .unit = true, .up = true, .gaps = true},
    .read = parse_csv,
    .write = write_csv,
};

}  // namespace moclean
