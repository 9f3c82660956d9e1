#pragma once

#include <Eigen/Geometry>

#include "support/limbs.hpp"

namespace moclean::test {

inline constexpr Index wrist = 8, thumb = 11, hand_joints = 12;

/// Limbs whose joint 8 has a hand of three joints, 9 to 11, that turns about it as one body,
/// [frames x 36].
inline Matrix limbs_with_hand(Index frames) {
  Matrix samples = swinging_limbs(frames, hand_joints);
  for (Index i = 0; i < frames; ++i) {
    const Eigen::Matrix3d turned =
        Eigen::AngleAxisd(0.02 * static_cast<double>(i), Eigen::Vector3d(1, 2, 3).normalized())
            .toRotationMatrix();
    const Eigen::Vector3d at = samples.row(i).segment<3>(3 * wrist);
    samples.row(i).segment<3>(27) = at + turned * Eigen::Vector3d(0.8, 0, 0);
    samples.row(i).segment<3>(30) = at + turned * Eigen::Vector3d(1.4, 0.2, 0);
    samples.row(i).segment<3>(33) = at + turned * Eigen::Vector3d(0.5, 0.6, 0.1);
  }
  return samples;
}

/// Puts a joint of the hand on the other side of the wrist in the frames [first, last), `reach`
/// times as far away.
inline void flip(Index joint, Index first, Index last, Matrix& samples, double reach = 1) {
  for (Index i = first; i < last; ++i) {
    const Eigen::RowVector3d at = samples.row(i).segment<3>(3 * wrist);
    samples.row(i).segment<3>(3 * joint) = at - reach * (samples.row(i).segment<3>(3 * joint) - at);
  }
}

}  // namespace moclean::test
