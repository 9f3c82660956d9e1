#include "moclean/run/same_file.hpp"

#include <map>
#include <system_error>

#include <fmt/format.h>
#include <sys/stat.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

// `-` is none, also where a file is called so.
std::string key_of(const NamedFile& named) { return named.file == "-" ? "" : file_key(named.file); }

}  // namespace

std::string file_key(const fs::path& file) {
  struct stat facts {};
  if (stat(file.c_str(), &facts) == 0) {
    if (!S_ISREG(facts.st_mode) && !S_ISDIR(facts.st_mode)) return "";
    return fmt::format("{}:{}", facts.st_dev, facts.st_ino);
  }
  const auto place = place_of_new(file);
  if (file.empty() || file == "-" || !place) return "";
  std::error_code error;
  const fs::path whole = fs::absolute(*place, error);
  const fs::path folder = fs::weakly_canonical(whole.parent_path(), error);
  return (error ? whole : folder / whole.filename()).lexically_normal().string();
}

void require_apart(std::span<const NamedFile> read, std::span<const NamedFile> written) {
  std::map<std::string, const NamedFile*> inputs;
  for (const NamedFile& input : read) inputs.emplace(key_of(input), &input);
  for (const NamedFile& output : written) {
    const std::string key = key_of(output);
    if (const auto same = inputs.find(key); !key.empty() && same != inputs.end())
      throw ArgumentError(fmt::format("{} {} is the file that {} names, which it would replace",
                                      output.option, output.file.string(), same->second->option));
  }
  require_apart(written);
}

void require_apart(std::span<const NamedFile> written) {
  std::map<std::string, const NamedFile*> outputs;
  for (const NamedFile& output : written) {
    const std::string key = key_of(output);
    if (key.empty()) continue;
    const auto [other, is_new] = outputs.emplace(key, &output);
    if (!is_new)
      throw ArgumentError(fmt::format("{} and {} would both write {}", other->second->option,
                                      output.option, output.file.string()));
  }
}

}  // namespace moclean
