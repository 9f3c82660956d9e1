#pragma once

#include <filesystem>
#include <numbers>
#include <string_view>

#include "moclean/motion/skeleton.hpp"

namespace moclean {

/// An Acclaim skeleton, and how its motion files are to be read.
///
/// Bone 0 is the root, then the hierarchy in depth-first order. A bone's `channels` are its `dof`
/// in reverse: ASF turns about rx first, so that `dof rx ry rz` means Rz Ry Rx.
struct AcclaimSkeleton {
  Skeleton skeleton;
  double radians_per_angle = std::numbers::pi / 180;  ///< of the file's angle unit
};

/// Reads Acclaim skeleton (ASF) text; `file` names it in messages. Throws FileError.
///
/// A bone of axis rotation C and motion rotation M turns by C M C^-1 about its parent's end, and
/// its joint is its own end, `direction * length` away (the root's joint is the root position).
/// `axis x y z XYZ` and `orientation` are angles about x, y, z in this order whatever the order
/// token, which says only which turn comes first. Lengths stay as written; the `length` factor of
/// `:units` is not applied. Limits, masses and unknown lines are skipped. The degree of freedom
/// `l` (bone length) is refused: no file at hand shows whether it adds or multiplies.
AcclaimSkeleton parse_asf(std::string_view text, const std::filesystem::path& file);

/// That of a file.
AcclaimSkeleton read_asf(const std::filesystem::path& file);

}  // namespace moclean
