#include "moclean/formats/line_log.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/write_whole.hpp"

namespace moclean {

LineLog::LineLog(std::filesystem::path file) : file_(std::move(file)) {
  std::error_code error;
  if (std::filesystem::exists(file_, error)) {
    const std::string text = read_file(file_);
    std::size_t begin = 0;
    for (std::size_t end; (end = text.find('\n', begin)) != text.npos; begin = end + 1)
      found_.push_back(text.substr(begin, end - begin));
    if (begin < text.size()) std::filesystem::resize_file(file_, begin, error);
    if (error) throw FileError(file_, "cannot be written: " + error.message());
  }
  descriptor_ = open(file_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(errno);
}

LineLog::~LineLog() {
  if (descriptor_ >= 0) close(descriptor_);
}

void LineLog::append(std::string_view line) {
  std::string whole(broken_ ? "\n" : "");
  whole += line;
  whole += '\n';
  broken_ = true;
  if (const int error = write_whole(descriptor_, whole); error != 0) fail(error);
  broken_ = false;
}

void LineLog::fail(int error) const {
  throw FileError(file_, "cannot be written: " + std::generic_category().message(error));
}

}  // namespace moclean
