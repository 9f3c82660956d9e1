#include "moclean/formats/line_log.hpp"

#include <system_error>
#include <utility>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"

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
  stream_.open(file_, std::ios::binary | std::ios::app);
  if (!stream_) throw FileError(file_, "cannot be opened for writing");
}

void LineLog::append(std::string_view line) {
  std::string whole(line);
  whole += '\n';
  stream_.write(whole.data(), static_cast<std::streamsize>(whole.size()));
  stream_.flush();
  if (!stream_) throw FileError(file_, "cannot be written: is the disk full?");
}

}  // namespace moclean
