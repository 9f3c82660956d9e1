#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "moclean/formats/read_write.hpp"

namespace moclean {

/// Replaces every folder among `inputs` by the recordings in it (of formats that can be read, not
/// those of sub-folders), sorted by name. Throws FileError for a file that does not exist or a
/// folder that holds no recording.
std::vector<std::filesystem::path> expand_folders(const std::vector<std::filesystem::path>& inputs);

/// What a method needs of a recording.
struct InputNeeds {
  bool every_sample = true;    ///< takes no NaN
  std::string frame_rate_for;  ///< the step that needs the frame rate; empty if none does
};

/// Throws FileError naming frame and column of a sample of a recording, these frames of a file,
/// that is too large for the solvers or missing where it must not be, and for one without the frame
/// rate needed.
void require_solvable(const Recording& recording, const std::filesystem::path& file,
                      const FrameRange& frames, const InputNeeds& needs = {});

}  // namespace moclean
