#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/formats/asf.hpp"
#include "moclean/formats/format.hpp"

namespace moclean {

/// What an AMC file says beside skeleton and channels; the Recording::source of one.
struct AmcDocument {
  std::string header;              ///< all text before the first frame, as written
  double radians_per_angle = 0;    ///< of the angles in it
  Index first_frame = 0;           ///< its number
  std::vector<std::size_t> order;  ///< bones of the skeleton as the first frame lists them
};

/// Reads Acclaim motion (AMC) text over its skeleton; `file` names it in messages. Throws
/// FileError.
///
/// Frames are numbered without a gap, from any first number; every frame gives all degrees of
/// freedom of every bone that has any (`:FULLY-SPECIFIED`), bones in any order. Angles are in the
/// skeleton's unit unless the file says `:DEGREES` or `:RADIANS`. Lengths stay as written, in
/// "ASF units"; the format states no frame rate.
SkeletonMotion parse_amc(std::string_view text, const std::filesystem::path& file,
                         const AcclaimSkeleton& skeleton);

/// Acclaim motion (.amc) with its skeleton (.asf): that of the options, else find_skeleton().
extern const Format amc_format;

}  // namespace moclean
