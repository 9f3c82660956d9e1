#include "moclean/motion/euler_angles.hpp"

#include <cmath>
#include <numbers>

namespace moclean {
namespace {

Eigen::Vector3d unwrapped(const Eigen::Vector3d& angles, const Eigen::Vector3d& reference) {
  return angles.binaryExpr(reference, [](double a, double b) { return nearest_turn(a, b); });
}

}  // namespace

double nearest_turn(double angle, double reference) {
  constexpr double turn = 2 * std::numbers::pi;
  return angle + turn * std::round((reference - angle) / turn);
}

Eigen::Vector3d nearest_angles(const Eigen::Vector3d& angles, const Eigen::Vector3d& reference) {
  constexpr double pi = std::numbers::pi;
  const Eigen::Vector3d same = unwrapped(angles, reference);
  const Eigen::Vector3d other =
      unwrapped({angles[0] + pi, pi - angles[1], angles[2] + pi}, reference);
  return (other - reference).squaredNorm() < (same - reference).squaredNorm() ? other : same;
}

Eigen::Vector3d euler_angles(const Eigen::Matrix3d& rotation, const std::array<int, 3>& axes,
                             const Eigen::Vector3d& reference) {
  const auto [i, j, k] = axes;
  const double sign = (i + 1) % 3 == j ? 1 : -1;  // of the order: x y z and its like, or not
  const double level = std::hypot(rotation(i, i), rotation(i, j));  // |cos b|
  constexpr double locked = 1e-9;
  const double a =
      level < locked ? reference[0] : std::atan2(-sign * rotation(j, k), rotation(k, k));
  const double b = std::atan2(sign * rotation(i, k), level);
  // c from what is left when a is taken off, so that the product is right also near the lock.
  const double cos_a = std::cos(a), sin_a = sign * std::sin(a);
  const double sin_c = cos_a * rotation(j, i) + sin_a * rotation(k, i);
  const double cos_c = cos_a * rotation(j, j) + sin_a * rotation(k, j);
  return nearest_angles({a, b, std::atan2(sign * sin_c, cos_c)}, reference);
}

}  // namespace moclean
