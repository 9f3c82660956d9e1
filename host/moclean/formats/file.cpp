#include "moclean/formats/file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "moclean/core/error.hpp"
#include "moclean/core/large_memory.hpp"
#include "moclean/formats/temporary_name.hpp"
#include "moclean/formats/unfinished.hpp"
#include "moclean/formats/write_whole.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

std::string text_of(int error) { return std::generic_category().message(error); }

// Closes an open file at the end.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }

 private:
  int number_;
};

// Reads up to so many bytes; less only at the end.
std::size_t read_up_to(const fs::path& file, int descriptor, char* bytes, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    constexpr std::size_t most = std::size_t{1} << 30;  // Linux reads less than 2 GiB at once
    const ssize_t some = ::read(descriptor, bytes + done, std::min(count - done, most));
    if (some == 0) break;
    if (some > 0)
      done += static_cast<std::size_t>(some);
    else if (errno != EINTR)
      throw FileError(file, "cannot be read to its end: " + text_of(errno));
  }
  return done;
}

// What is larger cannot be held, whatever the system promises when it is asked.
std::uint64_t memory_of_machine() {
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void require_room(const fs::path& file, std::uint64_t bytes) {
  if (bytes > memory_of_machine())
    throw FileError(file,
                    fmt::format("has {} bytes or more, which do not fit into the memory", bytes));
}

struct stat facts_of(const fs::path& file, int descriptor) {
  struct stat facts {};
  if (fstat(descriptor, &facts) != 0)
    throw FileError(file, "cannot be opened for reading: " + text_of(errno));
  if (!S_ISREG(facts.st_mode) && !S_ISFIFO(facts.st_mode))
    throw FileError(file, fmt::format("expected a file, found a {}",
                                      S_ISDIR(facts.st_mode) ? "folder" : "device"));
  return facts;
}

std::string content_of(const fs::path& file, int descriptor, std::uint64_t size) {
  std::string content;
  require_room(file, size);
  content.reserve(size);
  wish_huge_pages(content.data(), size);
  content.resize(size);
  content.resize(read_up_to(file, descriptor, content.data(), content.size()));
  // A pipe has no size, and a file may have grown since.
  char chunk[1 << 14];
  while (const std::size_t count = read_up_to(file, descriptor, chunk, sizeof chunk)) {
    content.append(chunk, count);
    require_room(file, content.size());
  }
  return content;
}

// Before a file loses its name to a new one, the new one has to be on the disk.
bool reaches_disk(const fs::path& file) {
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (opened.number() < 0) return false;
  return fsync(opened.number()) == 0 || errno == EINVAL || errno == ENOTSUP;
}

}  // namespace

std::optional<fs::path> place_of_new(const fs::path& file) {
  std::error_code error;
  const fs::file_status there = fs::status(file, error);
  if (fs::exists(there) && !fs::is_regular_file(there)) return std::nullopt;
  constexpr int most_links = 40;  // as Linux
  fs::path path = file;
  for (int i = 0; i < most_links; ++i) {
    if (!fs::is_symlink(path, error)) return path;
    const fs::path folder = fs::canonical(path.parent_path() / ".", error);
    if (!error && folder.native().starts_with("/proc/")) return std::nullopt;
    const fs::path next = fs::read_symlink(path, error);
    if (error) return std::nullopt;
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  return std::nullopt;
}

std::string read_file(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error) && !error) throw FileError(file, "there is no such file");
  std::optional<OutsideWait> wait;
  if (!fs::is_regular_file(file, error)) wait.emplace();
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY));
  if (opened.number() < 0) throw FileError(file, "cannot be opened for reading: " + text_of(errno));
  const struct stat facts = facts_of(file, opened.number());
  const auto size = static_cast<std::uint64_t>(facts.st_size);
  try {
    return content_of(file, opened.number(), size);
  } catch (const std::bad_alloc&) {
    throw FileError(file, fmt::format("does not fit into the memory ({} bytes)", size));
  }
}

// Delegates, so that the destructor removes the temporary file after a failure.
AtomicFile::AtomicFile(fs::path target) : AtomicFile() {
  target_ = std::move(target);
  std::error_code error;
  if (fs::is_directory(target_, error))
    throw FileError(target_, "cannot be written: there is a folder of that name");
  struct stat facts {};
  replaces_ = stat(target_.c_str(), &facts) == 0;
  const auto place = place_of_new(target_);
  // To a device or a pipe (/dev/null) a rename would put a file in its place.
  if (!place) {
    const OutsideWait wait;
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOCTTY);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  place_ = *place;
  const fs::path folder = place_.has_parent_path() ? place_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    throw FileError(target_, "cannot be written: there is no folder " + folder.string());
  if (replaces_ && access(place_.c_str(), W_OK) != 0) fail(errno);
  open_temporary();
  if (!replaces_) return;
  // Only root may give files away; else the new one is the writer's.
  [[maybe_unused]] const int ignored = fchown(descriptor_, facts.st_uid, facts.st_gid);
  if (fchmod(descriptor_, facts.st_mode & 0777) != 0) fail(errno);
}

void AtomicFile::open_temporary() {
  temporary_ = temporary_beside(place_);
  const mode_t mode = replaces_ ? S_IRUSR | S_IWUSR : 0666;
  int error = 0;
  const bool made = make_unfinished(temporary_, [&] {
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    error = errno;
    return descriptor_ >= 0;
  });
  if (made) return;
  temporary_.clear();
  const fs::path folder = place_.has_parent_path() ? place_.parent_path() : fs::path(".");
  throw FileError(target_, fmt::format("cannot be written: no new file in {}: {}", folder.string(),
                                       text_of(error)));
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)),
      place_(std::move(other.place_)),
      temporary_(std::exchange(other.temporary_, {})),
      replaces_(other.replaces_),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (temporary_.empty()) return;
  settle_unfinished(temporary_, [&] {
    std::error_code ignored;
    fs::remove(temporary_, ignored);
  });
}

void AtomicFile::fail(int error) const {
  throw FileError(target_, "cannot be written: " + text_of(error));
}

void AtomicFile::write(std::string_view bytes) {
  std::optional<OutsideWait> wait;
  if (temporary_.empty()) wait.emplace();
  if (const int error = write_whole(descriptor_, bytes); error != 0) fail(error);
}

void AtomicFile::close() {
  if (descriptor_ < 0) return;
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail(errno);
}

void AtomicFile::commit() {
  close();
  if (temporary_.empty()) return;
  if (replaces_ && !reaches_disk(temporary_)) fail(errno);
  int error = 0;
  settle_unfinished(temporary_, [&] {
    if (::rename(temporary_.c_str(), place_.c_str()) != 0) error = errno;
  });
  if (error == 0)
    temporary_.clear();
  else
    fail(error);
}

}  // namespace moclean
