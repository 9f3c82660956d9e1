#include "moclean/formats/file.hpp"

#include <random>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/large_memory.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

// Hidden, beside the target (a rename works only within a file system), and unlike the name any
// other process would choose for the same target.
fs::path temporary_beside(const fs::path& target) {
  std::random_device device;
  return target.parent_path() /
         fmt::format(".{}.{:08x}{:08x}.tmp", target.filename().string(), device(), device());
}

}  // namespace

bool is_left_of(const fs::path& file, const std::string& target_name) {
  constexpr std::size_t digits = 16;
  const std::string name = file.filename().string(), begin = "." + target_name + ".", end = ".tmp";
  if (name.size() != begin.size() + digits + end.size() || !name.starts_with(begin) ||
      !name.ends_with(end))
    return false;
  return name.find_first_not_of("0123456789abcdef", begin.size()) == begin.size() + digits;
}

std::string read_file(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw FileError(file, "there is no such file");
  if (fs::is_directory(file, error)) throw FileError(file, "expected a file, found a folder");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw FileError(file, "cannot be opened for reading");
  std::string content;
  if (const auto size = fs::file_size(file, error); !error) {
    content.reserve(size);
    wish_huge_pages(content.data(), size);
    content.resize(size);
  }
  stream.read(content.data(), static_cast<std::streamsize>(content.size()));
  content.resize(static_cast<std::size_t>(stream.gcount()));
  // A pipe has no size, and a file may have grown since.
  for (char chunk[4096]; stream.read(chunk, sizeof chunk), stream.gcount() > 0;)
    content.append(chunk, static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) throw FileError(file, "cannot be read to its end");
  return content;
}

AtomicFile::AtomicFile(fs::path target)
    : target_(std::move(target)), temporary_(temporary_beside(target_)) {
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw FileError(target_, "cannot be written: there is no folder " + folder.string());
  if (fs::is_directory(target_, error))
    throw FileError(target_, "cannot be written: there is a folder of that name");
  // A device or a pipe (/dev/null) is written to: a rename would put a file in its place.
  if (fs::exists(target_, error) && !fs::is_regular_file(target_, error)) {
    temporary_.clear();
    stream_.open(target_, std::ios::binary);
    if (!stream_) throw FileError(target_, "cannot be opened for writing");
    return;
  }
  stream_.open(temporary_, std::ios::binary);
  if (!stream_) throw FileError(target_, "cannot be written: no new file in " + folder.string());
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      stream_(std::move(other.stream_)) {}

AtomicFile::~AtomicFile() {
  if (temporary_.empty()) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) throw FileError(target_, "cannot be written: is the disk full?");
}

void AtomicFile::close() {
  if (!stream_.is_open()) return;
  stream_.close();
  if (!stream_) throw FileError(target_, "cannot be written: is the disk full?");
}

void AtomicFile::commit() {
  close();
  if (temporary_.empty()) return;
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) throw FileError(target_, "cannot be written: " + error.message());
  temporary_.clear();
}

}  // namespace moclean
