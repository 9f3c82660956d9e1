#include "moclean/motion/skeleton.hpp"

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

// turn <- turn * R(axis, angle): only two columns change.
void rotate(Eigen::Matrix3d& turn, int axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const Eigen::Vector3d old = turn.col(i);
  turn.col(i) = c * old + s * turn.col(j);
  turn.col(j) = c * turn.col(j) - s * old;
}

struct Pose {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d base = Eigen::Vector3d::Zero();
};

// Reads the step's channels at `value` and leaves `value` behind them.
Pose pose_of(const Step& step, const Pose& parent, const double*& value) {
  Pose pose;
  pose.base = parent.base + parent.turn * step.shift;
  pose.turn = step.between_is_identity ? parent.turn : parent.turn * step.between;
  const Eigen::Matrix3d frame = pose.turn;
  for (const Channel channel : *step.channels) {
    if (is_translation(channel))
      pose.base += *value * frame.col(axis_of(channel));
    else
      rotate(pose.turn, axis_of(channel), *value);
    ++value;
  }
  return pose;
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
  const Pose world;
  std::vector<Pose> poses(steps.size());
  Matrix positions(motion.rows(), static_cast<Index>(3 * steps.size()));
  for (Index frame = 0; frame < motion.rows(); ++frame) {
    const double* value = motion.data() + frame * motion.cols();
    double* out = positions.data() + frame * positions.cols();
    for (std::size_t b = 0; b < steps.size(); ++b, out += 3) {
      const Step& step = steps[b];
      const Pose& parent = step.parent < 0 ? world : poses[static_cast<std::size_t>(step.parent)];
      poses[b] = pose_of(step, parent, value);
      Eigen::Map<Eigen::Vector3d> joint(out);
      joint = poses[b].base;
      if (step.has_tail) joint += poses[b].turn * step.tail;
    }
  }
  return positions;
}

Clip joint_positions(const SkeletonMotion& motion) {
  Clip clip;
  clip.samples = forward_kinematics(motion.skeleton, motion.channels);
  for (const Bone& bone : motion.skeleton.bones)
    for (const char* axis : {".x", ".y", ".z"}) clip.columns.push_back(bone.name + axis);
  clip.frame_rate = motion.frame_rate;
  clip.unit = motion.unit;
  return clip;
}

}  // namespace moclean
