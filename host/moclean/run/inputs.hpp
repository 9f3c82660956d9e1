#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "moclean/formats/read_write.hpp"

namespace moclean {

/// Is asked about every file and folder found in a folder: whether it is no input.
using LeavesOut = std::function<bool(const std::filesystem::path&)>;

/// What was met in folders and could not be taken.
struct PassedBy {
  std::vector<std::filesystem::path> unreadable;  ///< folders
  std::vector<std::string> problems;              ///< a message for each of those
  std::vector<std::string> skipped;  ///< a message for each name of a recording that is none
};

/// Replaces every folder among `inputs` by the recordings in it and in its sub-folders (of formats
/// that can be read), sorted by path. Left out are hidden files and folders, what editors and
/// office programs keep beside an open file (`~$walk.csv`), the kept input `NAME.raw.EXT` beside a
/// `NAME.EXT`, what is no file (a link to nothing, a pipe), and what `leave_out` says. Links to
/// folders are followed, every folder is entered once. A file that is given twice, also within a
/// folder, is taken once. Throws FileError for a file that does not exist, a folder that holds no
/// recording or cannot be read; without `passed` also if that is one in another.
std::vector<std::filesystem::path> expand_folders(const std::vector<std::filesystem::path>& inputs,
                                                  const LeavesOut& leave_out = {},
                                                  PassedBy* passed = nullptr);

/// The name under which `NAME.EXT` is kept beside its result: `NAME.raw.EXT`.
std::filesystem::path raw_name(const std::filesystem::path& input);

/// The .asf without which an .amc cannot be read: `given`, or the one that is found for it. Empty
/// for other files, and where there is none, of which reading the file says more.
std::optional<std::filesystem::path> skeleton_of(const std::filesystem::path& file,
                                                 const std::filesystem::path& given);

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
