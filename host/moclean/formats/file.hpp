#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace moclean {

/// The whole content of a file. Throws FileError if it cannot be opened or read.
std::string read_file(const std::filesystem::path& file);

/// Whether a file is what an AtomicFile that was never destroyed (its process was killed) has left
/// of a target of this name, in the same folder.
bool is_left_of(const std::filesystem::path& file, const std::string& target_name);

/// A file that appears under its name only when it is complete.
///
/// Everything goes to a temporary file beside the target; commit() renames it. Without commit()
/// the destructor removes the temporary file and the target stays as it was. A target that is a
/// device or a pipe is written to at once.
class AtomicFile {
 public:
  /// Throws FileError if the target's folder does not exist or cannot be written.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;

  const std::filesystem::path& target() const { return target_; }

  /// Where the bytes are until commit().
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Appends bytes. Throws FileError, e.g. when the disk is full.
  void write(std::string_view bytes);

  /// Ends the writing, so that the file waits for commit() without being open. Throws FileError.
  void close();

  /// Puts the file in its place, over a file of that name. Throws FileError.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::ofstream stream_;
};

}  // namespace moclean
