// A new BVH file of any skeleton.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "moclean/formats/bvh.hpp"
#include "moclean/formats/channel_text.hpp"
#include "moclean/motion/euler_angles.hpp"

namespace moclean {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double usual_rate = 120;  // of Acclaim files, which state none
constexpr std::array<std::string_view, 6> bvh_channel_names = {
    "Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation"};
constexpr std::array<int, 3> zyx = {2, 1, 0};

// A joint of the new file.
struct BvhJoint {
  std::string name;
  Vector3d offset = Vector3d::Zero();
  int bone = -1;  // of the skeleton, that turns here; -1: none
  std::vector<std::size_t> children = {};
};

bool is_level(const Matrix3d& rotation) { return rotation.isIdentity(1e-12); }

bool has_translations(const Bone& bone) {
  return std::any_of(bone.channels.begin(), bone.channels.end(), is_translation);
}

// Whether BVH can say the bone's channels as they are: no constant rotation, no axis twice.
bool is_plain(const Bone& bone) {
  std::array<int, 6> count = {};
  for (const Channel channel : bone.channels) ++count[static_cast<std::size_t>(channel)];
  return !bone.channels.empty() && is_level(bone.before) && is_level(bone.after) &&
         *std::max_element(count.begin(), count.end()) == 1;
}

bool turns(const Bone& bone) {
  return !bone.channels.empty() || !is_level(bone.before * bone.after);
}

class NewBvh {
 public:
  NewBvh(AtomicFile& file, const Recording& recording)
      : file_(file), recording_(recording), bones_(recording.skeleton->bones) {
    for (const Bone& bone : bones_) {
      first_channel_.push_back(channels_);
      channels_ += static_cast<Index>(bone.channels.size());
      ++children_of_[static_cast<std::size_t>(bone.parent + 1)];
    }
    plan();
    spelling_.decimals = std::max(6, 7 - static_cast<int>(std::floor(std::log10(size()))));
  }

  void write(const Matrix& channels) {
    text_ = "HIERARCHY\n";
    hierarchy();
    const double rate = recording_.frame_rate > 0 ? recording_.frame_rate : usual_rate;
    text_ += fmt::format("MOTION\nFrames: {}\nFrame Time: {:.8g}\n", channels.rows(), 1 / rate);
    for (Index f = 0; f < channels.rows(); ++f) {
      for (const std::size_t joint : order_) put_channels(joint, channels.row(f).data());
      text_.back() = '\n';
      write_if_full(file_, text_);
    }
    file_.write(text_);
  }

 private:
  // The longest way from a root to a joint.
  double size() const {
    std::vector<double> reach(bones_.size());
    double most = 0;
    for (std::size_t b = 0; b < bones_.size(); ++b) {
      reach[b] = bones_[b].offset.norm() + bones_[b].tail.norm();
      if (bones_[b].parent >= 0) reach[b] += reach[static_cast<std::size_t>(bones_[b].parent)];
      most = std::max(most, reach[b]);
    }
    return most > 0 && std::isfinite(most) ? most : 1;
  }

  // A joint for every bone, under its name, where the skeleton has it; where the bone turns is that
  // joint, or its parent's, or one of its own.
  void plan() {
    for (std::size_t b = 0; b < bones_.size(); ++b) {
      const Bone& bone = bones_[b];
      const auto parent = static_cast<std::size_t>(std::max(bone.parent, 0));
      std::size_t at = bone.parent < 0 ? none : joint_of_[parent];
      Vector3d offset = bone.offset;
      const bool is_far = !bone.tail.isZero(0) && turns(bone);
      const bool parent_is_free =
          at != none && joints_[at].bone < 0 && children_of_[parent + 1] == 1;
      if (is_far && parent_is_free && bone.offset.isZero(0) && !has_translations(bone)) {
        joints_[at].bone = static_cast<int>(b);
      } else if (is_far) {
        at = add({.name = bone.name + "_start", .offset = offset, .bone = static_cast<int>(b)}, at);
      }
      if (is_far) offset = Vector3d::Zero();
      const bool turns_here = !is_far && turns(bone);
      joint_of_.push_back(add({.name = bone.name,
                               .offset = offset + bone.tail,
                               .bone = turns_here ? static_cast<int>(b) : -1},
                              at));
    }
  }

  std::size_t add(BvhJoint joint, std::size_t parent) {
    joints_.push_back(std::move(joint));
    (parent == none ? roots_ : joints_[parent].children).push_back(joints_.size() - 1);
    return joints_.size() - 1;
  }

  // Any depth: what is to be closed stands on a stack of its own.
  void hierarchy() {
    constexpr std::size_t closing = static_cast<std::size_t>(-1);
    std::vector<std::size_t> open(roots_.rbegin(), roots_.rend());
    std::size_t depth = 0;
    while (!open.empty()) {
      const std::size_t joint = open.back();
      open.pop_back();
      if (joint == closing) {
        line(--depth, "}");
        continue;
      }
      begin_joint(depth++, joints_[joint]);
      order_.push_back(joint);
      angles_.push_back(Vector3d::Zero());
      const std::vector<std::size_t>& children = joints_[joint].children;
      if (children.empty()) {
        line(depth, "End Site");
        line(depth, "{");
        line(depth + 1, "OFFSET 0 0 0");
        line(depth, "}");
      }
      open.push_back(closing);
      open.insert(open.end(), children.rbegin(), children.rend());
      write_if_full(file_, text_);
    }
  }

  void begin_joint(std::size_t depth, const BvhJoint& joint) {
    line(depth, fmt::format("{} {}", depth == 0 ? "ROOT" : "JOINT", joint.name));
    line(depth, "{");
    line(depth + 1,
         fmt::format("OFFSET {} {} {}", joint.offset.x(), joint.offset.y(), joint.offset.z()));
    std::string names;
    const std::vector<Channel> channels = channels_at(joint);
    for (const Channel channel : channels)
      names += fmt::format(" {}", bvh_channel_names[static_cast<std::size_t>(channel)]);
    line(depth + 1, fmt::format("CHANNELS {}{}", channels.size(), names));
  }

  std::vector<Channel> channels_at(const BvhJoint& joint) const {
    using enum Channel;
    const Bone* const bone = bone_at(joint);
    if (bone && is_plain(*bone)) {  // positions first: many readers know no other order
      std::vector<Channel> channels = bone->channels;
      const auto turns = std::stable_partition(channels.begin(), channels.end(), is_translation);
      std::sort(channels.begin(), turns);
      return channels;
    }
    if (bone && has_translations(*bone))
      return {translate_x, translate_y, translate_z, rotate_z, rotate_y, rotate_x};
    return {rotate_z, rotate_y, rotate_x};
  }

  const Bone* bone_at(const BvhJoint& joint) const {
    return joint.bone < 0 ? nullptr : &bones_[static_cast<std::size_t>(joint.bone)];
  }

  void line(std::size_t depth, const std::string& words) {
    constexpr std::size_t deepest = 40;  // of what is indented: text grows with the joints alone
    text_.append(2 * std::min(depth, deepest), ' ');
    text_ += words;
    text_ += '\n';
  }

  void put_channels(std::size_t index, const double* frame) {
    const BvhJoint& joint = joints_[index];
    const Bone* const bone = bone_at(joint);
    if (!bone) {
      text_ += "0 0 0 ";
      return;
    }
    const double* values = frame + first_channel_[static_cast<std::size_t>(joint.bone)];
    if (is_plain(*bone)) {
      for (const Channel channel : channels_at(joint)) {
        const auto place = std::find(bone->channels.begin(), bone->channels.end(), channel);
        const double value = values[place - bone->channels.begin()];
        put(is_translation(channel) ? joint.offset[axis_of(channel)] + value
                                    : value / radians_per_degree_);
      }
      return;
    }
    Vector3d travel = Vector3d::Zero();
    Matrix3d turn = bone->before;
    for (const Channel channel : bone->channels) {
      const Vector3d axis = Vector3d::Unit(axis_of(channel));
      if (is_translation(channel))
        travel += *values++ * axis;
      else
        turn = turn * Eigen::AngleAxisd(*values++, axis).toRotationMatrix();
    }
    if (has_translations(*bone))
      for (const double place : Vector3d(joint.offset + bone->before * travel)) put(place);
    Vector3d& before = angles_[index];
    const Vector3d angles = euler_angles(turn * bone->after, zyx, before);
    if (angles.allFinite()) before = angles;
    for (const double angle : angles) put(angle / radians_per_degree_);
  }

  void put(double value) {
    spelling_.put(value, text_);
    text_ += ' ';
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  static constexpr double radians_per_degree_ = std::numbers::pi / 180;

  AtomicFile& file_;
  const Recording& recording_;
  const std::vector<Bone>& bones_;
  std::vector<Index> first_channel_;
  Index channels_ = 0;
  std::vector<int> children_of_ = std::vector<int>(recording_.skeleton->bones.size() + 1);
  std::vector<BvhJoint> joints_;
  std::vector<std::size_t> roots_, joint_of_, order_;  // order: as the file lists them
  std::vector<Vector3d> angles_;                       // per joint: of the frame before
  ChannelSpelling spelling_;
  std::string text_;
};

}  // namespace

void write_new_bvh(AtomicFile& file, const Recording& recording, const Matrix& channels) {
  NewBvh(file, recording).write(channels);
}

}  // namespace moclean
