#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace moclean {

/// The members of a zip archive in memory, as libzip reads it.
class ZipArchive {
 public:
  /// `content` outlives the archive; `file` names it in messages. Throws FileError unless it is a
  /// zip archive.
  ZipArchive(std::string_view content, std::filesystem::path file);
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  const std::vector<std::string>& names() const { return names_; }

  /// The content of a member. Throws FileError if it is damaged, encrypted, or more than 100 times
  /// as large as the whole archive.
  std::string member(const std::string& name) const;

 private:
  std::size_t size_;
  std::filesystem::path file_;
  void* archive_;  // zip_t, whose header stays out of this one
  std::vector<std::string> names_;
};

/// An archive with other contents of some members, the others as they are and in their order, new
/// ones behind them; an empty `content` makes a new one. The same input gives the same bytes at any
/// time. `file` names it in messages. Throws FileError.
std::string with_members(std::string_view content,
                         const std::map<std::string, std::string>& members,
                         const std::filesystem::path& file);

}  // namespace moclean
