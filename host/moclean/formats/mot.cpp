#include "moclean/formats/mot.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/table_document.hpp"
#include "moclean/formats/text_scanner.hpp"
#include "moclean/formats/written_text.hpp"

namespace moclean {
namespace {

constexpr std::string_view mot_extension = ".mot", sto_extension = ".sto";

Recording read_mot(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions& options) {
  return read_table(content, file, options, mot_extension);
}

Recording read_sto(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions& options) {
  return read_table(content, file, options, sto_extension);
}

void write_new_storage(AtomicFile& file, const Recording& recording) {
  if (!(recording.frame_rate > 0))
    throw FileError(file.target(),
                    "cannot be written: its times need a frame rate (--rate states it)");
  std::string text =
      fmt::format("{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees=no\nendheader\ntime",
                  file.target().stem().string(), recording.frames(), recording.samples.cols() + 1);
  for (const std::string& name : recording.columns) {
    if (name.find_first_of("\t\r\n") != std::string::npos)
      throw FileError(file.target(), "cannot be written: the column name " + excerpt(name) +
                                         " holds a tab or a line break");
    text += "\t" + name;
  }
  text += '\n';
  std::array<char, 32> number{};
  for (Index f = 0; f < recording.frames(); ++f) {
    text += fmt::to_string(static_cast<double>(f) / recording.frame_rate);
    for (const double sample : recording.samples.row(f)) {
      char* const end = std::to_chars(number.data(), number.data() + number.size(), sample).ptr;
      text += '\t';
      text += std::isnan(sample) ? std::string_view("nan") : std::string_view(number.data(), end);
    }
    text += '\n';
    write_if_full(file, text);
  }
  file.write(text);
}

void write_storage(AtomicFile& file, const Recording& recording, std::string_view extension) {
  if (const TableDocument* const document = table_of(recording, extension))
    write_table(file, *document, recording);
  else
    write_new_storage(file, recording);
}

void write_mot(AtomicFile& file, const Recording& recording) {
  write_storage(file, recording, mot_extension);
}

void write_sto(AtomicFile& file, const Recording& recording) {
  write_storage(file, recording, sto_extension);
}

}  // namespace

constinit const Format mot_format = {
    .name = "MOT",
    .extension = mot_extension,
    .notes =
        "motion of OpenSim: joint angles, each a channel by itself; all but the samples is kept",
    .content = {.names = true, .frame_rate = true, .gaps = true},
    .read = read_mot,
    .write = write_mot,
};

constinit const Format sto_format = {
    .name = "STO",
    .extension = sto_extension,
    .notes = "storage of OpenSim with a number per cell, likewise",
    .content = {.names = true, .frame_rate = true, .gaps = true},
    .read = read_sto,
    .write = write_sto,
};

}  // namespace moclean
