#include "moclean/motion/pose_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "moclean/motion/euler_angles.hpp"

namespace moclean {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double unchanged = 1e-9;      // of the body's size, or radians
constexpr double least_damping = 1e-7;  // of the squared size: far below what turning a bone costs
constexpr double small_damping = 1e-4;  // under which a small step means a small slope
constexpr double most_damping = 1e3;
constexpr double smallest_turn = 1e-7;  // of a step worth another: the next is its square
constexpr double level = 1e-8;          // share by which steps lessen what noise leaves
constexpr int most_steps = 80;

// The rotation that brings arms nearest to their aims, given sum(aim arm') (Kabsch 1976).
Matrix3d best_rotation(const Matrix3d& products) {
  const Eigen::JacobiSVD<Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

Matrix3d PoseSolver::turn_about(int axis, double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::Unit(axis)).toRotationMatrix();
}

PoseSolver::PoseSolver(const Skeleton& skeleton)
    : links_(skeleton.bones.size()), children_(links_.size()), kept_(links_.size()) {
  std::vector<double> reach(links_.size());
  Index channel = 0;
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Bone& bone = skeleton.bones[b];
    Link& link = links_[b];
    link.parent = bone.parent;
    link.shift = bone.offset;
    link.between = bone.before;
    link.tail = bone.after * bone.tail;
    link.channels = bone.channels;
    link.first_channel = channel;
    channel += static_cast<Index>(bone.channels.size());
    reach[b] = bone.tail.norm();
    if (bone.parent >= 0) {
      const auto p = static_cast<std::size_t>(bone.parent);
      const Bone& parent = skeleton.bones[p];
      link.shift = parent.after * (parent.tail + bone.offset);
      link.between = parent.after * bone.before;
      children_[p].push_back(b);
      reach[b] += reach[p] + bone.offset.norm();
    }
    add_freedoms(link);
    size_ = std::max(size_, reach[b]);
  }
}

void PoseSolver::add_freedoms(Link& link) const {
  std::array<int, 3> moves = {}, turns = {};
  std::vector<std::size_t> rotations;
  for (std::size_t c = 0; c < link.channels.size(); ++c) {
    const auto axis = static_cast<std::size_t>(axis_of(link.channels[c]));
    ++(is_translation(link.channels[c]) ? moves : turns)[axis];
    if (!is_translation(link.channels[c])) rotations.push_back(c);
  }
  const bool has_moves = std::ranges::max(moves) == 1;
  link.travels = link.parent < 0 && has_moves;
  if (rotations.empty() || rotations.size() > 3) return;
  const bool in_a_row = rotations.back() - rotations.front() + 1 == rotations.size();
  link.most = Freedom::about_axes;
  if (turns != std::array{1, 1, 1} || !in_a_row) return;
  link.most = Freedom::any;
  link.turn.first = link.first_channel + static_cast<Index>(rotations.front());
  for (std::size_t i = 0; i < 3; ++i) link.turn.axes[i] = axis_of(link.channels[rotations[i]]);
}

void PoseSolver::solve(const double* positions, const double* current, double* channels) {
  if (!look_at(positions, current)) return;
  place(channels);
  choose_freedoms();
  aim();
  double damping = least_damping, best = distance();
  bool is_smooth = true;  // the last step lessened the distance: steps may be bolder at once
  const double none = unchanged * unchanged * size_ * size_ * static_cast<double>(links_.size());
  for (int step = 0; step < most_steps && damping <= most_damping && best > none; ++step) {
    keep(kept_);
    const double turned = take_step(damping);
    const double now = distance();
    if (now > best * (1 + 1e-9)) {
      restore(kept_);
      damping *= 5;
      is_smooth = false;
      continue;
    }
    const bool is_level = best - now <= level * now;
    best = now;
    damping = std::max(least_damping, damping / (is_smooth ? 10 : 2));
    is_smooth = true;
    if ((is_level || turned < smallest_turn) && damping < small_damping) break;
  }
  write(channels);
}

// False if no joint has moved.
bool PoseSolver::look_at(const double* positions, const double* current) {
  bool is_any = false;
  for (std::size_t b = 0; b < links_.size(); ++b) {
    Link& link = links_[b];
    link.target = Eigen::Map<const Vector3d>(positions + 3 * b);
    link.is_seen = link.target.allFinite();
    const Vector3d way = link.target - Eigen::Map<const Vector3d>(current + 3 * b);
    link.has_changed = link.is_seen && way.norm() > unchanged * size_;
    link.has_changed_above = false;
    if (link.parent >= 0) {
      Link& parent = links_[static_cast<std::size_t>(link.parent)];
      link.has_changed_above = parent.has_changed_above || parent.has_changed;
      parent.is_active |= link.has_changed;
    }
    link.is_active = link.has_changed || link.has_changed_above;
    is_any |= link.has_changed;
  }
  for (std::size_t b = links_.size(); is_any && b-- > 0;)  // joints behind one that is not seen
    if (const Link& link = links_[b]; !link.is_seen && link.is_active && link.parent >= 0)
      links_[static_cast<std::size_t>(link.parent)].is_active = true;
  return is_any;
}

Matrix3d PoseSolver::frame_of(const Link& link) const {
  if (link.parent < 0) return link.between;
  return links_[static_cast<std::size_t>(link.parent)].pose.turned * link.between;
}

// All bones by their channels.
void PoseSolver::place(const double* channels) {
  for (Link& link : links_) {
    Pose& pose = link.pose;
    pose.travel.setZero();
    pose.local.setIdentity();
    std::size_t turns = 0;
    for (std::size_t c = 0; c < link.channels.size(); ++c) {
      const double value = channels[link.first_channel + static_cast<Index>(c)];
      const int axis = axis_of(link.channels[c]);
      if (is_translation(link.channels[c])) {
        pose.travel[axis] += value;
        continue;
      }
      pose.local = pose.local * turn_about(axis, value);
      if (turns < 3) pose.angles[turns++] = value;
    }
    link.freedom = Freedom::none;
    carry(link);
  }
}

// Puts the bone where its parent and its channels have it; one that turns freely keeps its
// orientation.
void PoseSolver::carry(Link& link) {
  const Matrix3d frame = frame_of(link);
  link.pose.base = frame * link.pose.travel;
  if (link.parent < 0) {
    link.pose.base += link.shift;
  } else {
    const Pose& parent = links_[static_cast<std::size_t>(link.parent)].pose;
    link.pose.base += parent.base + parent.turned * link.shift;
  }
  if (link.freedom != Freedom::any) link.pose.turned = frame * link.pose.local;
}

// A turn that moves no joint that is seen is none.
void PoseSolver::choose_freedoms() {
  for (std::size_t b = links_.size(); b-- > 0;) {
    Link& link = links_[b];
    link.limb_is_seen = link.is_seen;
    link.turn_is_seen = link.is_seen && !link.tail.isZero(0);
    for (const std::size_t c : children_[b]) {
      const Link& child = links_[c];
      const bool has_lever = (child.pose.base - link.pose.base).norm() > unchanged * size_;
      link.limb_is_seen |= child.limb_is_seen;
      link.turn_is_seen |=
          has_lever ? child.limb_is_seen : child.freedom == Freedom::none && child.turn_is_seen;
    }
    link.freedom = link.is_active && link.turn_is_seen ? link.most : Freedom::none;
  }
}

// Turns every free bone, root first, so that its children lie in their directions as seen from
// where it is.
void PoseSolver::aim() {
  for (std::size_t b = 0; b < links_.size(); ++b) {
    Link& link = links_[b];
    const Freedom freedom = std::exchange(link.freedom, Freedom::none);
    if (link.travels && link.is_active && link.is_seen && link.tail.isZero(0))
      for (const Channel channel : link.channels)
        if (is_translation(channel)) {
          const int axis = axis_of(channel);
          link.pose.travel[axis] = link.between.col(axis).dot(link.target - link.shift);
        }
    carry(link);
    link.freedom = freedom;
    if (freedom == Freedom::any) aim_at_children(b);
  }
}

void PoseSolver::aim_at_children(std::size_t bone) {
  Link& link = links_[bone];
  Matrix3d products = Matrix3d::Zero();
  Vector3d arm, aim;
  int count = 0;
  const auto add = [&](const Vector3d& from, const Link& end) {
    if (!end.is_seen || from.norm() <= unchanged * size_) return;
    arm = link.pose.turned * from;
    aim = end.target - link.pose.base;
    if (aim.norm() <= unchanged * size_) return;
    products += aim * arm.transpose();
    ++count;
  };
  if (!link.tail.isZero(0)) add(link.tail, link);
  for (const std::size_t c : children_[bone]) {
    const Link& child = links_[c];
    if (child.tail.isZero(0)) add(child.shift + child.between * child.pose.travel, child);
  }
  if (count == 1)
    link.pose.turned = Eigen::Quaterniond::FromTwoVectors(arm, aim) * link.pose.turned;
  if (count > 1) {
    products.diagonal().array() += 1e-6 * products.norm();  // decides where children are in line
    link.pose.turned = best_rotation(products) * link.pose.turned;
  }
}

double PoseSolver::distance() const {
  double sum = 0;
  for (const Link& link : links_)
    if (link.is_seen)
      sum += (link.pose.base + link.pose.turned * link.tail - link.target).squaredNorm();
  return sum;
}

// The channels of bones that may move; one that did not keeps its bits.
void PoseSolver::write(double* channels) const {
  const auto put = [channels](Index place, double value, double least) {
    if (std::abs(value - channels[place]) > least) channels[place] = value;
  };
  for (const Link& link : links_) {
    if (!link.is_active) continue;
    Vector3d angles(link.pose.angles.data());
    if (link.freedom == Freedom::any) {
      const Vector3d before(channels + link.turn.first);
      angles = euler_angles(frame_of(link).transpose() * link.pose.turned, link.turn.axes, before);
    }
    Index turns = 0;
    for (std::size_t c = 0; c < link.channels.size(); ++c) {
      const Index place = link.first_channel + static_cast<Index>(c);
      if (!is_translation(link.channels[c])) {
        if (link.freedom != Freedom::none)
          put(place, nearest_turn(angles[turns++], channels[place]), unchanged);
      } else if (link.travels) {
        put(place, link.pose.travel[axis_of(link.channels[c])], unchanged * size_);
      }
    }
  }
}

void PoseSolver::keep(std::vector<Pose>& poses) const {
  for (std::size_t b = 0; b < links_.size(); ++b) poses[b] = links_[b].pose;
}

void PoseSolver::restore(const std::vector<Pose>& poses) {
  for (std::size_t b = 0; b < links_.size(); ++b) links_[b].pose = poses[b];
}

}  // namespace moclean
