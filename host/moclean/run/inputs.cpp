#include "moclean/run/inputs.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "moclean/backend/backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/core/usable.hpp"
#include "moclean/formats/formats.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> recordings_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_of_format(entry.path(), can_read))
      found.push_back(entry.path());
  if (found.empty())
    throw FileError(folder, fmt::format("holds no recording ({})", any_extension(can_read)));
  std::ranges::sort(found);
  return found;
}

}  // namespace

std::vector<fs::path> expand_folders(const std::vector<fs::path>& inputs) {
  std::vector<fs::path> files;
  for (const fs::path& input : inputs) {
    if (!fs::exists(input)) throw FileError(input, "there is no such file or folder");
    if (!fs::is_directory(input)) {
      files.push_back(input);
      continue;
    }
    for (fs::path& file : recordings_in(input)) files.push_back(std::move(file));
  }
  return files;
}

// The solvers refuse such samples, too, but know neither the file nor the frame in it.
void require_solvable(const Recording& recording, const fs::path& file, const FrameRange& frames,
                      const InputNeeds& needs) {
  if (!needs.frame_rate_for.empty() && !(recording.frame_rate > 0))
    throw FileError(file, fmt::format("states no frame rate, which {} needs; give --rate HZ",
                                      needs.frame_rate_for));
  if (recording.samples.size() == 0) throw FileError(file, "holds no samples");
  const auto place = first_unusable(recording.samples, !needs.every_sample, largest_entry);
  if (!place) return;
  const double sample = recording.samples(place->frame, place->column);
  throw FileError(
      file, fmt::format("frame {}, column {} is {}; {}", frames.first.value_or(0) + place->frame,
                        recording.columns[static_cast<std::size_t>(place->column)], sample,
                        std::isnan(sample) ? "missing samples are not supported by this method"
                                           : "expected a number of sensible size"));
}

}  // namespace moclean
