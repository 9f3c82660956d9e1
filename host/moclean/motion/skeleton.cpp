#include "moclean/motion/skeleton.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

// A bone as the frame loop wants it. All constant factors between the rotation channels of the
// parent and those of the bone are multiplied once, so the loop carries, per bone, only
//   base:  where the bone turns,
//   turn:  the orientation after its rotation channels, before Bone::after.
struct Step {
  int parent;
  Eigen::Vector3d shift;    // parent's base to this base, in the parent's turn
  Eigen::Matrix3d between;  // parent's turn to the frame of this bone's channels
  bool between_is_identity;
  Eigen::Vector3d tail;  // base to joint, in this bone's turn
  bool has_tail;
  const std::vector<Channel>* channels;
};

std::vector<Step> plan_steps(const Skeleton& skeleton) {
  std::vector<Step> steps;
  steps.reserve(skeleton.bones.size());
  for (const Bone& bone : skeleton.bones) {
    if (bone.parent < -1 || bone.parent >= static_cast<int>(steps.size()))
      throw ShapeError(fmt::format("bone '{}' has parent {}, expected an earlier bone or -1",
                                   bone.name, bone.parent));
    Step step{bone.parent, bone.offset,   bone.before, false, bone.after * bone.tail,
              false,       &bone.channels};
    if (bone.parent >= 0) {
      const Bone& parent = skeleton.bones[static_cast<std::size_t>(bone.parent)];
      step.shift = parent.after * (parent.tail + bone.offset);
      step.between = parent.after * bone.before;
    }
    step.between_is_identity = step.between.isIdentity(0);
    step.has_tail = !step.tail.isZero(0);
    steps.push_back(step);
  }
  return steps;
}

// Frames are computed several side by side, a number of each in a lane of a vector register. Every
// lane does what a single frame would, in the same order.
constexpr Index lanes = 4;
using Lanes = Eigen::Array<double, lanes, 1>;
using LaneVector = std::array<Lanes, 3>;

struct Pose {
  LaneVector base = {Lanes::Zero(), Lanes::Zero(), Lanes::Zero()};
  std::array<LaneVector, 3> turn = {{{Lanes::Ones(), Lanes::Zero(), Lanes::Zero()},
                                     {Lanes::Zero(), Lanes::Ones(), Lanes::Zero()},
                                     {Lanes::Zero(), Lanes::Zero(), Lanes::Ones()}}};  // columns
};

// turn * vector, component by component.
Lanes row_times(const std::array<LaneVector, 3>& turn, std::size_t row,
                const Eigen::Vector3d& vector) {
  return turn[0][row] * vector[0] + turn[1][row] * vector[1] + turn[2][row] * vector[2];
}

// turn <- turn * R(axis, angle): only two columns change.
void rotate(std::array<LaneVector, 3>& turn, int axis, const Lanes& angle) {
  Lanes c, s;
  for (Index lane = 0; lane < lanes; ++lane) {
    c[lane] = std::cos(angle[lane]);
    s[lane] = std::sin(angle[lane]);
  }
  LaneVector& a = turn[static_cast<std::size_t>(axis + 1) % 3];
  LaneVector& b = turn[static_cast<std::size_t>(axis + 2) % 3];
  for (std::size_t row = 0; row < 3; ++row) {
    const Lanes old = a[row];
    a[row] = c * old + s * b[row];
    b[row] = c * b[row] - s * old;
  }
}

// The frames of one pass: where their numbers are, and where their joints go. The last pass repeats
// the last frame where there are too few.
struct Frames {
  std::array<const double*, lanes> values;
  std::array<double*, lanes> joints;

  Lanes value(Index channel) const {
    Lanes all;
    for (Index lane = 0; lane < lanes; ++lane)
      all[lane] = values[static_cast<std::size_t>(lane)][channel];
    return all;
  }

  void place(std::size_t bone, const LaneVector& position) const {
    for (std::size_t lane = 0; lane < lanes; ++lane)
      for (std::size_t axis = 0; axis < 3; ++axis)
        joints[lane][3 * bone + axis] = position[axis][static_cast<Index>(lane)];
  }
};

// Reads the step's channels from `channel` on and leaves it behind them.
Pose pose_of(const Step& step, const Pose& parent, const Frames& frames, Index& channel) {
  Pose pose = parent;
  for (std::size_t row = 0; row < 3; ++row) {
    pose.base[row] += row_times(parent.turn, row, step.shift);
    if (step.between_is_identity) continue;
    for (Index column = 0; column < 3; ++column)
      pose.turn[static_cast<std::size_t>(column)][row] =
          row_times(parent.turn, row, step.between.col(column));
  }
  const std::array<LaneVector, 3> frame = pose.turn;
  for (const Channel kind : *step.channels) {
    const Lanes value = frames.value(channel++);
    const int axis = axis_of(kind);
    if (!is_translation(kind)) {
      rotate(pose.turn, axis, value);
      continue;
    }
    for (std::size_t row = 0; row < 3; ++row)
      pose.base[row] += value * frame[static_cast<std::size_t>(axis)][row];
  }
  return pose;
}

void place_joints(const std::vector<Step>& steps, const Frames& frames, std::vector<Pose>& poses) {
  const Pose world;
  Index channel = 0;
  for (std::size_t b = 0; b < steps.size(); ++b) {
    const Step& step = steps[b];
    const Pose& parent = step.parent < 0 ? world : poses[static_cast<std::size_t>(step.parent)];
    poses[b] = pose_of(step, parent, frames, channel);
    LaneVector joint = poses[b].base;
    if (step.has_tail)
      for (std::size_t row = 0; row < 3; ++row)
        joint[row] += row_times(poses[b].turn, row, step.tail);
    frames.place(b, joint);
  }
}

}  // namespace

Index Skeleton::channels() const {
  Index sum = 0;
  for (const Bone& bone : bones) sum += static_cast<Index>(bone.channels.size());
  return sum;
}

Matrix forward_kinematics(const Skeleton& skeleton, const Matrix& motion) {
  if (motion.cols() != skeleton.channels())
    throw ShapeError(fmt::format("the motion has {} numbers per frame, its skeleton {} channels",
                                 motion.cols(), skeleton.channels()));
  const std::vector<Step> steps = plan_steps(skeleton);
  std::vector<Pose> poses(steps.size());
  Matrix positions(motion.rows(), static_cast<Index>(3 * steps.size()));
  for (Index first = 0; first < motion.rows(); first += lanes) {
    Frames frames;
    for (Index lane = 0; lane < lanes; ++lane) {
      const Index frame = std::min(first + lane, motion.rows() - 1);
      frames.values[static_cast<std::size_t>(lane)] = motion.row(frame).data();
      frames.joints[static_cast<std::size_t>(lane)] = positions.row(frame).data();
    }
    place_joints(steps, frames, poses);
  }
  return positions;
}

}  // namespace moclean
