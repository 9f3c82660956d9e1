#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "moclean/motion/recording.hpp"

namespace moclean::test {

/// A new folder that is removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// The path of a file in the folder.
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  /// Writes a clip and returns its path.
  std::string write(const std::string& name, const Recording& clip) const;

  /// Writes a text file and returns its path.
  std::string write_text(const std::string& name, const std::string& text) const;

  /// The names of everything in it, hidden files included, sorted; sub-folders as `name/file`.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

/// The whole content of a file.
std::string content(const std::filesystem::path& file);

}  // namespace moclean::test
