#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/formats/asf.hpp"
#include "moclean/formats/format.hpp"

namespace moclean {

/// An AMC file as written. The FramedSource::file of a recording is a shared pointer to it.
struct AmcDocument {
  std::string text;              ///< all of it
  std::size_t rows = 0;          ///< where in it the first frame begins
  double radians_per_angle = 0;  ///< of the angles in it
  Index first_number = 0;        ///< that the first frame has in it
  Index frames = 0;
};

/// Reads Acclaim motion (AMC) text over its skeleton; `file` names it in messages. Throws
/// FileError.
///
/// Frames are numbered without a gap, from any first number; every frame gives all degrees of
/// freedom of every bone that has any (`:FULLY-SPECIFIED`), bones in any order. Angles are in the
/// skeleton's unit unless the file says `:DEGREES` or `:RADIANS`. A number may be missing (see
/// TextScanner::accept_number()). Lengths stay as written, in "ASF units"; the format states no
/// frame rate.
SkeletonMotion parse_amc(std::string_view text, const std::filesystem::path& file,
                         const AcclaimSkeleton& skeleton);

/// Writes a recording of an AMC file as such a file again: its header, comments, numbers of frames,
/// bones in their order. The positions of joints that were changed become rotations by
/// inverse_kinematics(), within the degrees of freedom that the skeleton gives its bones; their
/// `limits` are not looked at. Every number that stays the same keeps its text, another one gets as
/// many decimals as the file uses, at least 4. A file of which nothing was changed comes back byte
/// for byte. Throws FileError for a recording that is not of an AMC file, or no longer.
void write_amc(AtomicFile& file, const Recording& recording);

/// Acclaim motion (.amc) with its skeleton (.asf): that of the options, else find_skeleton().
extern const Format amc_format;

}  // namespace moclean
