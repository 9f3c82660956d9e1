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

// Whether the input has the same rotation in two frames, nearly, by other angles.
bool input_wraps(const Matrix& given, Index first, Index frame) {
  constexpr double small = 0.5;
  const GivenAngles input(&given(frame, first)), before(&given(frame - 1, first));
  const Eigen::Vector3d near = nearest_angles(input, before);
  return near != input && largest_step(near, before) < small;
}

// Where the angles of a bone jump between two frames, though the same rotation has others that do
// not, they follow the frame before; unless the input wraps there, too.
void follow(const Matrix& given, Index first, Matrix& found) {
  constexpr double half_turn = std::numbers::pi;
  for (Index f = 1; f < found.rows(); ++f) {
    Angles angles(&found(f, first));
    const Angles before(&found(f - 1, first));
    const GivenAngles input(&given(f, first));
    if (angles == input || largest_step(angles, before) <= half_turn) continue;
    const Eigen::Vector3d near = nearest_angles(angles, before);
    if (largest_step(near, before) <= half_turn && !input_wraps(given, first, f)) angles = near;
  }
}

// The same of one angle.
void follow_turn(const Matrix& given, Index channel, Matrix& found) {
  constexpr double half_turn = std::numbers::pi, small = 0.5;
  for (Index f = 1; f < found.rows(); ++f) {
    double& angle = found(f, channel);
    const double before = found(f - 1, channel), input = given(f, channel),
                 input_before = given(f - 1, channel);
    if (angle == input || std::abs(angle - before) <= half_turn) continue;
    const double near = nearest_turn(input, input_before);
    if (near == input || std::abs(near - input_before) >= small)
      angle = nearest_turn(angle, before);
  }
}

void follow_all(const Skeleton& skeleton, const Matrix& given, Matrix& found) {
  const PoseSolver solver(skeleton);
  Index channel = 0;
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
    const Index first = solver.turn_of(b).first;
    if (first >= 0) follow(given, first, found);
    for (const Channel kind : skeleton.bones[b].channels) {
      if (first < 0 && !is_translation(kind)) follow_turn(given, channel, found);
      ++channel;
    }
  }
}

// The largest step of the rotations of a frame that are not those given, from the frame before;
// whole turns, and steps where the input wraps, are none.
double largest_turn(const Skeleton& skeleton, const std::vector<PoseSolver::Turn>& turns,
                    const Matrix& given, const Matrix& found, Index frame, const double* row) {
  double most = 0;
  Index channel = 0;
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
    const bool wraps = turns[b].first >= 0 && input_wraps(given, turns[b].first, frame);
    for (const Channel kind : skeleton.bones[b].channels) {
      const double before = found(frame - 1, channel);
      if (!wraps && !is_translation(kind) && found(frame, channel) != given(frame, channel))
        most = std::max(most, std::abs(nearest_turn(row[channel], before) - before));
      ++channel;
    }
  }
  return most;
}

// Where rotations jump, the search begins once more, from those of the frame before: damage may
// have thrown the input to where a bone bends the other way (two degrees of freedom reach a
// direction twice). What it finds is taken if it is as near and jumps less. True if any was.
bool search_from_before(const Skeleton& skeleton, const Matrix& given, const Matrix& positions,
                        const Matrix& current, Matrix& found) {
  constexpr double jump = std::numbers::pi / 2;
  bool is_any = false;
  PoseSolver solver(skeleton);
  std::vector<PoseSolver::Turn> turns;
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) turns.push_back(solver.turn_of(b));
  for (Index f = 1; f < found.rows(); ++f) {
    const double turn = largest_turn(skeleton, turns, given, found, f, found.row(f).data());
    if (turn <= jump) continue;
    const Matrix old = found.row(f);
    Matrix row = old;
    for (Index c = 0; c < row.cols(); ++c)
      if (old(0, c) != given(f, c)) row(0, c) = found(f - 1, c);
    solver.solve(positions.row(f).data(), current.row(f).data(), row.data());
    const auto distance = [&](const Matrix& channels) {
      const auto way = (forward_kinematics(skeleton, channels) - positions.row(f)).array().eval();
      return way.isNaN().select(0, way).square().sum();
    };
    const double least =
        1e-12 * positions.row(f).array().isNaN().select(0, positions.row(f)).squaredNorm();
    if (largest_turn(skeleton, turns, given, found, f, row.data()) < turn &&
        distance(row) <= 1.02 * distance(old) + least) {
      found.row(f) = row;
      is_any = true;
    }
  }
  return is_any;
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
  const Matrix start = has_missing ? filled_channels(channels) : channels;
  follow_all(skeleton, start, found);
  if (search_from_before(skeleton, start, positions, current, found))
    follow_all(skeleton, start, found);
  for (Index f = 0; has_missing && f < found.rows(); ++f)
    leave_missing(skeleton, channels.row(f).data(), positions.row(f).data(), found.row(f).data());
  return found;
}

}  // namespace moclean
