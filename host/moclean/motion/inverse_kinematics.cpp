#include "moclean/motion/inverse_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

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

bool is_missing(double value) { return std::isnan(value); }

// Channels with a number in the place of those that are missing: between the neighbours in time,
// or, where these are half a turn apart, that of the nearest frame before; 0 where there is none.
Matrix filled_channels(const Matrix& channels) {
  Matrix filled = channels;
  for (Index c = 0; c < filled.cols(); ++c) {
    Index last = -1;  // that has a number
    for (Index f = 0; f < filled.rows(); ++f) {
      if (is_missing(channels(f, c))) continue;
      const double here = channels(f, c), before = last < 0 ? here : channels(last, c);
      const bool is_near = std::abs(here - before) < std::numbers::pi;
      for (Index g = last + 1; g < f; ++g) {
        const double share = static_cast<double>(g - last) / static_cast<double>(f - last);
        filled(g, c) = is_near ? before + share * (here - before) : before;
      }
      last = f;
    }
    filled.col(c).tail(filled.rows() - 1 - last).setConstant(last < 0 ? 0 : channels(last, c));
  }
  return filled;
}

// Makes the channels of a frame missing again that no joint which was observed tells of: those of
// a bone that drives none.
void leave_missing(const Skeleton& skeleton, const double* given, const double* positions,
                   double* found) {
  std::vector<bool> limb_is_seen(skeleton.bones.size()), turn_is_seen(skeleton.bones.size());
  for (std::size_t b = skeleton.bones.size(); b-- > 0;) {
    const Bone& bone = skeleton.bones[b];
    const bool is_seen = Eigen::Map<const Eigen::Vector3d>(positions + 3 * b).allFinite();
    if (is_seen && !bone.tail.isZero(0)) turn_is_seen[b] = true;
    limb_is_seen[b] = limb_is_seen[b] || is_seen;
    if (bone.parent < 0 || !limb_is_seen[b]) continue;
    limb_is_seen[static_cast<std::size_t>(bone.parent)] = true;
    turn_is_seen[static_cast<std::size_t>(bone.parent)] = true;
  }
  Index channel = 0;
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b)
    for (const Channel kind : skeleton.bones[b].channels) {
      const bool is_told = is_translation(kind) ? limb_is_seen[b] : turn_is_seen[b];
      if (is_missing(given[channel]) && !is_told) found[channel] = given[channel];
      ++channel;
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
  const bool has_missing = channels.array().isNaN().any();
  Matrix found = has_missing ? filled_channels(channels) : channels;
  const Matrix current = forward_kinematics(skeleton, found);
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
  for (Index f = 0; has_missing && f < found.rows(); ++f)
    leave_missing(skeleton, channels.row(f).data(), positions.row(f).data(), found.row(f).data());
  return found;
}

}  // namespace moclean
