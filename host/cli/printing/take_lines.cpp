#include "cli/printing/take_lines.hpp"

#include "moclean/core/error.hpp"

#include "cli/printing/standard_output.hpp"

namespace moclean::cli {

TakeLines::TakeLines(const std::filesystem::path& file) : file_(file) {
  if (file_.empty() || file_ == "-") return;
  stream_.open(file_, std::ios::binary | std::ios::trunc);
  if (!stream_) throw FileError(file_, "cannot be opened for writing");
}

void TakeLines::add(const Json& record) {
  if (file_.empty()) return;
  const std::string line = record.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  if (file_ == "-") {
    write_output(line);
    output_failure();  // flushes; the end of the program tells of it
    return;
  }
  stream_.write(line.data(), static_cast<std::streamsize>(line.size()));
  stream_.flush();
  failed_ = !stream_ || failed_;
}

void TakeLines::check() {
  if (failed_) throw FileError(file_, "cannot be written: is the disk full?");
}

}  // namespace moclean::cli
