#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/program.hpp"
#include "formats/tiny_files.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::test {

/// A walk of a few columns, so that it is soon cleaned.
inline Recording small_walk(Index frames, std::uint64_t seed = 9) {
  Recording walk = synthetic_walk(frames, seed);
  walk.samples.conservativeResize(frames, 12);
  walk.columns.resize(12);
  return walk;
}

/// The files below a folder, without folders, hidden files included.
inline std::vector<std::string> files_below(const TemporaryFolder& folder,
                                            const std::string& name) {
  std::vector<std::string> found;
  for (const std::string& path : folder.names())
    if (path.starts_with(name + "/") && !std::filesystem::is_directory(folder / path))
      found.push_back(path.substr(name.size() + 1));
  return found;
}

/// Their names and contents.
inline std::vector<std::pair<std::string, std::string>> contents_below(
    const TemporaryFolder& folder, const std::string& name) {
  std::vector<std::pair<std::string, std::string>> found;
  for (const std::string& path : files_below(folder, name))
    found.emplace_back(path, content(folder / (name + "/" + path)));
  return found;
}

/// The records of JSON lines.
inline std::vector<nlohmann::json> lines_of(const std::string& text) {
  std::vector<nlohmann::json> records;
  for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != text.npos; begin = end + 1)
    records.push_back(nlohmann::json::parse(text.substr(begin, end - begin)));
  return records;
}

/// `moclean denoise` with a filter, which needs no device.
inline Outcome denoise_quickly(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "denoise");
  if (std::ranges::find(arguments, "--config") == arguments.end() &&
      std::ranges::find(arguments, "--method") == arguments.end())
    arguments.insert(arguments.end(), {"--method", "median"});
  return run(arguments);
}

}  // namespace moclean::test
