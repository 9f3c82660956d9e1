#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace moclean {

/// The whole content of a file, or of a pipe until its other side is closed. Throws FileError if it
/// cannot be opened or read, is no file or pipe, or is larger than the memory of the machine.
std::string read_file(const std::filesystem::path& file);

/// Where a file that is written under this name comes to stand: the name, or where its links lead,
/// also if nothing is there yet. Nothing where it is written to as it stands: a device, a pipe,
/// what a process has open (/dev/stdout), and where the links go round.
std::optional<std::filesystem::path> place_of_new(const std::filesystem::path& file);

/// A file that appears under its name only when it is complete.
///
/// Everything goes to a temporary file beside the target (temporary_name.hpp); commit() renames it.
/// Without commit() the destructor removes the temporary file and the target stays as it was. A
/// target that is there keeps its permissions; one that is a link stays one, and the file it leads
/// to is replaced. A target without a place_of_new() is written to at once.
class AtomicFile {
 public:
  /// Throws FileError if the target's folder does not exist or cannot be written, or the target is
  /// write-protected.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;

  const std::filesystem::path& target() const { return target_; }

  /// Where the bytes are until commit(); empty where they are under their name at once.
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Appends bytes. Throws FileError, e.g. when the disk is full.
  void write(std::string_view bytes);

  /// Ends the writing, so that the file waits for commit() without being open. Throws FileError.
  void close();

  /// Puts the file in its place, over a file of that name. Throws FileError.
  void commit();

 private:
  AtomicFile() = default;
  void open_temporary();
  [[noreturn]] void fail(int error) const;

  std::filesystem::path target_;
  std::filesystem::path place_;  // the target, or where its links lead
  std::filesystem::path temporary_;
  bool replaces_ = false;
  int descriptor_ = -1;
};

}  // namespace moclean
