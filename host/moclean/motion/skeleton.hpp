#pragma once

#include <any>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// What one number of a frame drives.
enum class Channel { translate_x, translate_y, translate_z, rotate_x, rotate_y, rotate_z };

/// True for the three translations, false for the three rotations.
constexpr bool is_translation(Channel channel) { return channel <= Channel::translate_z; }

/// The axis a channel moves along or turns about: 0, 1, 2 for x, y, z.
constexpr int axis_of(Channel channel) { return static_cast<int>(channel) % 3; }

/// One joint of a skeleton. Its transform relative to the parent joint is
///   translate(offset) * before * translate(t) * R * after * translate(tail),
/// where t holds the translation channels and R is the product of the rotation channels, first
/// channel leftmost: {rotate_z, rotate_x} is Rz Rx. Translations come first wherever they stand
/// among the channels.
///
/// BVH uses offset and channels alone. An ASF bone turns about its near end, in the frame `axis`,
/// and its joint is the far end: before = axis, after = axis^-1, tail = direction * length.
struct Bone {
  std::string name;
  int parent = -1;                                   ///< index of an earlier bone; -1 for a root
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< from the parent's joint, file units
  Eigen::Matrix3d before = Eigen::Matrix3d::Identity();  ///< rotation
  std::vector<Channel> channels = {};                    ///< any set in any order
  Eigen::Matrix3d after = Eigen::Matrix3d::Identity();   ///< rotation
  Eigen::Vector3d tail = Eigen::Vector3d::Zero();        ///< file units
};

/// A tree of bones (or several trees), parents before children.
struct Skeleton {
  std::vector<Bone> bones;

  /// Numbers in one frame: the sum of all bones' channels, bone after bone.
  Index channels() const;
};

/// A recorded motion of a skeleton: what BVH and ASF/AMC files hold.
struct SkeletonMotion {
  Skeleton skeleton;
  Matrix channels;        ///< [frames x skeleton.channels()], translations in file units, radians
  double frame_rate = 0;  ///< Hz; 0 where unknown
  std::string unit;       ///< of lengths; empty where the file does not state it
  std::any source = {};   ///< see Recording::source
  std::vector<std::string> warnings = {};  ///< see ReadingNotes
};

/// Joint positions of every frame, [frames x 3 bones], in the unit of the skeleton's offsets.
/// `motion` is [frames x channels()]: translations in file units, rotations in radians.
/// Throws ShapeError if its width differs from channels(), or if a parent stands after its child.
Matrix forward_kinematics(const Skeleton& skeleton, const Matrix& motion);

}  // namespace moclean
