#include "moclean/motion/inverse_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/parallel.hpp"
#include "moclean/motion/euler_angles.hpp"
#include "moclean/motion/pose_solver.hpp"

namespace moclean {
namespace {

using Angles = Eigen::Map<Eigen::Vector3d>;
using GivenAngles = Eigen::Map<const Eigen::Vector3d>;

double largest_step(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

// Where the angles of a bone jump between two frames, though the same rotation has others that do
// not, they follow the frame before; unless the
// input wraps there, too.
void follow(const Matrix& given, Index first, Matrix& found) {
  constexpr double half_turn = std::numbers::pi, small = 0.5;
  for (Index f = 1; f < found.rows(); ++f) {
    Angles angles(&found(f, first));
    const Angles before(&found(f - 1, first));
    const GivenAngles input(&given(f, first)), input_before(&given(f - 1, first));
    if (angles == input || largest_step(angles, before) <= half_turn) continue;
    const Eigen::Vector3d input_near = nearest_angles(input, input_before);
    const bool input_wraps = input_near != input && largest_step(input_near, input_before) < small;
    const Eigen::Vector3d near = nearest_angles(angles, before);
    if (!input_wraps && largest_step(near, before) <= half_turn) angles = near;
  }
}

}  // namespace

Matrix inverse_kinematics(const Skeleton& skeleton, const Matrix& channels, const Matrix& positions,
                          int jobs) {
  const auto bones = static_cast<Index>(skeleton.bones.size());
  if (positions.rows() != channels.rows() || positions.cols() != 3 * bones)
    throw ShapeError(
        fmt::format("expected positions of {} frames x {} joints, found {} x {} numbers",
                    channels.rows(), bones, positions.rows(), positions.cols()));
  const Matrix current = forward_kinematics(skeleton, channels);
  Matrix found = channels;
  constexpr Index frames_at_once = 64;
  const Index blocks = (found.rows() + frames_at_once - 1) / frames_at_once;
  for_each_index(blocks, jobs, [&](Index block) {
    PoseSolver solver(skeleton);
    const Index last = std::min(found.rows(), (block + 1) * frames_at_once);
    for (Index f = block * frames_at_once; f < last; ++f)
      solver.solve(positions.row(f).data(), current.row(f).data(), found.row(f).data());
  });
  const PoseSolver solver(skeleton);
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b)
    if (const Index first = solver.turn_of(b).first; first >= 0) follow(channels, first, found);
  return found;
}

}  // namespace moclean
