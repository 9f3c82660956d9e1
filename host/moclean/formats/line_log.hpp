#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace moclean {

/// A text file that grows by whole lines and survives being cut off at any byte: a last line
/// without its line end is no line, and one that could not be written whole stands by itself. Meant
/// for results worth keeping when a run is killed; it is flushed to the system after every append,
/// not to the disk.
class LineLog {
 public:
  /// Reads the lines there are, removes what a killed writer left of a line, and opens the file for
  /// more; makes it if it does not exist. Throws FileError if it cannot be read or written.
  explicit LineLog(std::filesystem::path file);
  ~LineLog();
  LineLog(const LineLog&) = delete;
  LineLog& operator=(const LineLog&) = delete;

  const std::filesystem::path& file() const { return file_; }

  /// The lines that were there, without their ends.
  const std::vector<std::string>& found() const { return found_; }

  /// Appends text and a line end; the text holds none. Throws FileError, e.g. when the disk is
  /// full.
  void append(std::string_view line);

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path file_;
  std::vector<std::string> found_;
  int descriptor_ = -1;
  bool broken_ = false;  // the last line has no end
};

}  // namespace moclean
