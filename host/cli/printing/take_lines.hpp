#pragma once

#include <filesystem>
#include <fstream>

#include "cli/printing/json_record.hpp"

namespace moclean::cli {

/// JSON lines, a record per take, that others can read while the run goes on.
class TakeLines {
 public:
  TakeLines() = default;

  /// Makes the file anew; `-` is standard output. Throws FileError.
  explicit TakeLines(const std::filesystem::path& file);

  /// Writes a line and flushes it; nothing without a file. Throws nothing: see check().
  void add(const Json& record);

  /// Throws FileError if a line could not be written.
  void check();

 private:
  std::filesystem::path file_;
  std::ofstream stream_;
  bool failed_ = false;
};

}  // namespace moclean::cli
