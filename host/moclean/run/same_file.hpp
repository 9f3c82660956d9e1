#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace moclean {

/// What all names of one file have in common, be they links, hard links or spelled otherwise, also
/// of a file that is not there yet. Empty for no name, and for a device or a pipe, which nothing
/// replaces.
std::string file_key(const std::filesystem::path& file);

/// A file that a command reads or writes, and the option that names it.
struct NamedFile {
  std::string_view option;
  std::filesystem::path file;  ///< empty and `-` are none
};

/// Throws ArgumentError if two written files are one, or one is a file that is read.
void require_apart(std::span<const NamedFile> read, std::span<const NamedFile> written);

/// Likewise for the written files among themselves: what is read may be replaced.
void require_apart(std::span<const NamedFile> written);

}  // namespace moclean
