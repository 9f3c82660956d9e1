#include "moclean/formats/skeleton_positions.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {

Recording skeleton_positions(SkeletonMotion motion, const std::filesystem::path& file,
                             std::size_t bytes) {
  constexpr double least = 64 << 20, per_byte = 64;
  const std::size_t joints = motion.skeleton.bones.size();
  const double needed = static_cast<double>(motion.channels.rows()) * static_cast<double>(joints) *
                        3 * sizeof(double);
  if (needed > std::max(least, per_byte * static_cast<double>(bytes)))
    throw FileError(file,
                    fmt::format("{} frames of {} joints, of which few have channels, would take "
                                "{:.0f} MB, out of proportion to the file",
                                motion.channels.rows(), joints, needed / 1e6));
  return joint_positions(std::move(motion));
}

}  // namespace moclean
