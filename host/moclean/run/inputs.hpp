#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "moclean/motion/recording.hpp"

namespace moclean {

/// Frames A up to but not including B, counted from 0; either end may be left open.
struct FrameRange {
  std::optional<Index> first;
  std::optional<Index> last;
};

/// How recordings are read.
struct InputOptions {
  FrameRange frames;
  double rate = 0;                 ///< Hz; 0 where not given
  std::filesystem::path skeleton;  ///< of .amc files; empty: look beside them
};

/// The frames of a clip that were asked for. Throws ArgumentError naming `file` if the clip has
/// fewer.
Recording select_frames(const Recording& clip, const FrameRange& frames,
                        const std::filesystem::path& file);

/// Reads one recording and selects its frames.
Recording read_input(const std::filesystem::path& file, const InputOptions& options);

/// Replaces every folder among `inputs` by the recordings in it (of formats that can be read, not
/// those of sub-folders), sorted by name. Throws FileError for a file that does not exist or a
/// folder that holds no recording.
std::vector<std::filesystem::path> expand_folders(const std::vector<std::filesystem::path>& inputs);

/// What a method needs of a recording.
struct InputNeeds {
  bool every_sample = true;    ///< takes no NaN
  std::string frame_rate_for;  ///< the step that needs the frame rate; empty if none does
};

/// As read_input(), and throws FileError naming frame and column of a sample that is too large for
/// the solvers or missing where it must not be, and for a recording without the frame rate needed.
Recording read_solvable(const std::filesystem::path& file, const InputOptions& options,
                        const InputNeeds& needs = {});

}  // namespace moclean
