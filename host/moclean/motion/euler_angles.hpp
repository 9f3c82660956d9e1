#pragma once

#include <array>

#include <Eigen/Core>

namespace moclean {

/// The angles a, b, c, in radians, of the rotation R_i(a) R_j(b) R_k(c) about three different axes
/// (0, 1, 2 for x, y, z; the first leftmost, as Bone has them), of all that give it those nearest
/// to `reference`. Where the middle turn makes the outer axes one, the first angle is that of the
/// reference.
Eigen::Vector3d euler_angles(const Eigen::Matrix3d& rotation, const std::array<int, 3>& axes,
                             const Eigen::Vector3d& reference);

/// The angles of the same rotation nearest to others: turns more or less, or the other way round
/// the middle axis (a + pi, pi - b, c + pi).
Eigen::Vector3d nearest_angles(const Eigen::Vector3d& angles, const Eigen::Vector3d& reference);

/// The angle of the same turn about one axis, whole turns more or less, nearest to another.
double nearest_turn(double angle, double reference);

}  // namespace moclean
