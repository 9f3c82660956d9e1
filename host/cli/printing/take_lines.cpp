#include "cli/printing/take_lines.hpp"

#include <cstdio>

#include "moclean/core/error.hpp"

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
    failed_ = std::fwrite(line.data(), 1, line.size(), stdout) != line.size() ||
              std::fflush(stdout) != 0 || failed_;
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
