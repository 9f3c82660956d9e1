#include "moclean/formats/temporary_name.hpp"

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <random>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include "moclean/core/error.hpp"
#include "moclean/core/hash.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/unfinished.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t digits = 24;
constexpr std::string_view ending = ".tmp";
constexpr std::size_t longest_stem = 96;  // bytes of NAME: names may have 255, in places 143

// What tells processes of equal numbers apart: the machine and, of containers, which.
std::uint32_t machine() {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  struct stat space {};
  const bool known = stat("/proc/self/ns/pid", &space) == 0;
  const std::uint64_t hash =
      Fnv1a().text(host).text(fmt::format("{}", known ? space.st_ino : 0)).value();
  return static_cast<std::uint32_t>(hash ^ hash >> 32);
}

std::string stem_of(const std::string& target_name) { return target_name.substr(0, longest_stem); }

// The digits of a temporary name; empty if it is none.
std::string_view digits_of(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(ending)) return {};
  name.remove_suffix(ending.size());
  if (name.size() < digits + 2 || name[name.size() - digits - 1] != '.') return {};
  const std::string_view found = name.substr(name.size() - digits);
  return found.find_first_not_of("0123456789abcdef") == found.npos ? found : std::string_view();
}

std::uint32_t number_in(std::string_view hexadecimal) {
  std::uint32_t number = 0;
  std::from_chars(hexadecimal.data(), hexadecimal.data() + hexadecimal.size(), number, 16);
  return number;
}

// A number may be that of another process by now; then its file stays until that has ended.
bool is_left(const fs::path& file) {
  const std::string name = file.filename().string();
  const std::string_view found = digits_of(name);
  if (found.empty() || number_in(found.substr(0, 8)) != machine()) return false;
  const auto process = static_cast<pid_t>(number_in(found.substr(8, 8)));
  if (process == getpid()) return !is_unfinished(file.filename());
  return process > 0 && kill(process, 0) != 0 && errno == ESRCH;
}

}  // namespace

fs::path temporary_beside(const fs::path& target) {
  std::random_device device;
  return target.parent_path() / fmt::format(".{}.{:08x}{:08x}{:08x}{}",
                                            stem_of(target.filename().string()), machine(),
                                            static_cast<std::uint32_t>(getpid()), device(), ending);
}

bool is_temporary_of(const fs::path& file, const std::string& target_name) {
  const std::string name = file.filename().string(), begin = "." + stem_of(target_name) + ".";
  return name.size() == begin.size() + digits + ending.size() && name.starts_with(begin) &&
         !digits_of(name).empty();
}

fs::path make_temporary_folder() {
  std::error_code error;
  const fs::path around = fs::temp_directory_path(error);
  if (error) throw FileError(around, "cannot be used for temporary files: " + error.message());
  remove_left_in(around);
  fs::path folder = temporary_beside(around / "moclean");
  if (!make_unfinished(
          folder, [&] { return mkdir(folder.c_str(), 0700) == 0; }, UnfinishedFolder::with_content))
    throw FileError(folder, "cannot be created");
  return folder;
}

void remove_left_in(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> left;
  const auto is_ours = [](const fs::path& path) {
    struct stat facts {};
    if (lstat(path.c_str(), &facts) != 0) return false;
    return S_ISREG(facts.st_mode) || (S_ISDIR(facts.st_mode) && facts.st_uid == geteuid());
  };
  for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error), end;
       !error && entry != end; entry.increment(error))
    if (is_left(entry->path()) && is_ours(entry->path())) left.push_back(entry->path());
  for (const fs::path& path : left) fs::remove_all(path, error);
}

void remove_left_beside(const fs::path& file) {
  if (file.empty()) return;
  if (const auto place = place_of_new(file)) remove_left_in(place->parent_path());
}

}  // namespace moclean
