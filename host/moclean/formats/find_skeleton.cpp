#include "moclean/formats/find_skeleton.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "moclean/core/error.hpp"
#include "moclean/formats/extension.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> skeletons_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (extension(entry->path()) == ".asf") found.push_back(entry->path());
  std::sort(found.begin(), found.end());
  return found;
}

// The stem and what is left of it when it is cut at each `_`, longest first.
std::vector<std::string> candidate_stems(std::string stem) {
  std::vector<std::string> stems = {stem};
  for (std::size_t end = stem.rfind('_'); end != std::string::npos && end > 0;
       end = stem.rfind('_', end - 1))
    stems.push_back(stem.substr(0, end));
  return stems;
}

}  // namespace

fs::path find_skeleton(const fs::path& amc) {
  const fs::path folder = amc.has_parent_path() ? amc.parent_path() : fs::path(".");
  const std::vector<fs::path> skeletons = skeletons_in(folder);
  std::string tried;
  for (const std::string& stem : candidate_stems(amc.stem().string())) {
    for (const fs::path& skeleton : skeletons)
      if (skeleton.stem() == stem) return skeleton;
    tried += stem + ".asf, ";
  }
  if (skeletons.size() == 1) return skeletons.front();
  throw FileError(amc, "has no skeleton in " + folder.string() + ": looked for " + tried +
                           "or a single .asf (there are " + std::to_string(skeletons.size()) + ")");
}

}  // namespace moclean
