#include "moclean/run/inputs.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/usable.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/solve/backend.hpp"

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

// The solvers refuse such samples, too, but know neither the file nor the frame in it.
void require_solvable(const Recording& clip, const FrameRange& frames, const fs::path& file,
                      const InputNeeds& needs) {
  if (!needs.frame_rate_for.empty() && !(clip.frame_rate > 0))
    throw FileError(file, fmt::format("states no frame rate, which {} needs; give --rate HZ",
                                      needs.frame_rate_for));
  if (clip.samples.size() == 0) throw FileError(file, "holds no samples");
  const auto place = first_unusable(clip.samples, !needs.every_sample, largest_entry);
  if (!place) return;
  const double sample = clip.samples(place->frame, place->column);
  throw FileError(
      file, fmt::format("frame {}, column {} is {}; {}", frames.first.value_or(0) + place->frame,
                        clip.columns[static_cast<std::size_t>(place->column)], sample,
                        std::isnan(sample) ? "missing samples are not supported by this method"
                                           : "expected a number of sensible size"));
}

}  // namespace

Recording select_frames(const Recording& clip, const FrameRange& frames, const fs::path& file) {
  const Index first = frames.first.value_or(0);
  const Index last = frames.last.value_or(clip.frames());
  if (first >= last || last > clip.frames())
    throw ArgumentError(fmt::format("--frames {}:{} is out of range: {} has {} frames", first,
                                    frames.last ? std::to_string(last) : "", file.string(),
                                    clip.frames()));
  return cut(clip, first, last);
}

Recording read_input(const fs::path& file, const InputOptions& options) {
  Recording clip = read_recording(file, {.skeleton = options.skeleton, .rate = options.rate});
  if (!options.frames.first && !options.frames.last) return clip;
  return select_frames(clip, options.frames, file);
}

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

Recording read_solvable(const fs::path& file, const InputOptions& options,
                        const InputNeeds& needs) {
  Recording clip = read_input(file, options);
  require_solvable(clip, options.frames, file, needs);
  return clip;
}

}  // namespace moclean
