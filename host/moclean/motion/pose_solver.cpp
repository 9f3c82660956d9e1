#include "moclean/motion/pose_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
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
constexpr int most_steps = 30;

Matrix3d about(int axis, double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::Unit(axis)).toRotationMatrix();
}

// cross(a) b = a x b
Matrix3d cross(const Vector3d& a) {
  Matrix3d matrix;
  matrix << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return matrix;
}

Matrix3d by(const Vector3d& spin) {
  const double angle = spin.norm();
  if (angle < 1e-300) return Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, spin / angle).toRotationMatrix();
}

// The rotation that brings arms nearest to their aims, given sum(aim arm') (Kabsch 1976).
Matrix3d best_rotation(const Matrix3d& products) {
  const Eigen::JacobiSVD<Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

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
  for (int step = 0; step < most_steps && damping <= most_damping; ++step) {
    keep(kept_);
    const double turned = take_step(damping);
    const double now = distance();
    if (now > best * (1 + 1e-9)) {
      restore(kept_);
      damping *= 10;
      continue;
    }
    best = now;
    damping = std::max(least_damping, damping / 10);
    if (turned < smallest_turn && damping < small_damping) break;
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
      pose.local = pose.local * about(axis, value);
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
    if (freedom != Freedom::any) continue;
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
    for (const std::size_t c : children_[b]) {
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
}

double PoseSolver::distance() const {
  double sum = 0;
  for (const Link& link : links_)
    if (link.is_seen)
      sum += (link.pose.base + link.pose.turned * link.tail - link.target).squaredNorm();
  return sum;
}

// The world axes of a bone's rotation channels, in columns.
Matrix3d PoseSolver::axes_of(const Link& link) const {
  Matrix3d axes = Matrix3d::Zero(), turned = frame_of(link);
  Index count = 0;
  for (const Channel channel : link.channels) {
    if (is_translation(channel)) continue;
    axes.col(count) = turned.col(axis_of(channel));
    turned = turned * about(axis_of(channel), link.pose.angles[static_cast<std::size_t>(count++)]);
  }
  return axes;
}

// The costs of all limbs, from the tips inwards.
void PoseSolver::find_costs(double damping) {
  for (Link& link : links_) link.cost = Cost();
  for (std::size_t b = links_.size(); b-- > 0;) {
    Link& link = links_[b];
    if (!link.limb_is_seen) continue;
    Cost& own = link.cost;
    if (link.is_seen) {
      const Vector3d arm = link.pose.turned * link.tail;
      const Vector3d error = link.pose.base + arm - link.target;
      const Matrix3d lever = -cross(arm);
      own.dd += Matrix3d::Identity();
      own.dw += lever;
      own.ww += lever.transpose() * lever;
      own.gd += error;
      own.gw += lever.transpose() * error;
    }
    const Cost cost = cost_at_parent(link, damping);
    if (link.parent < 0) {
      link.rest = cost;
      continue;
    }
    Link& parent = links_[static_cast<std::size_t>(link.parent)];
    const Matrix3d lever = -cross(link.pose.base - parent.pose.base);
    const Matrix3d turn = lever.transpose() * cost.dw;
    parent.cost.dd += cost.dd;
    parent.cost.dw += cost.dd * lever + cost.dw;
    parent.cost.ww += lever.transpose() * cost.dd * lever + turn + turn.transpose() + cost.ww;
    parent.cost.gd += cost.gd;
    parent.cost.gw += lever.transpose() * cost.gd + cost.gw;
  }
}

// The cost with the bone's own turns at their best, of motions of its base and of its parent's
// orientation.
PoseSolver::Cost PoseSolver::cost_at_parent(Link& link, double damping) const {
  const Cost& own = link.cost;
  Cost rest = own;
  if (link.freedom == Freedom::none) return rest;
  const bool is_free = link.freedom == Freedom::any;
  link.axes = is_free ? Matrix3d::Identity() : axes_of(link);
  Matrix3d turns = link.axes.transpose() * own.ww * link.axes;
  turns.diagonal().array() += damping;
  link.inverse = turns.inverse();
  const Matrix3d dq = own.dw * link.axes;
  const Vector3d gq = link.axes.transpose() * own.gw;
  rest.dd -= dq * link.inverse * dq.transpose();
  rest.gd -= dq * (link.inverse * gq);
  if (is_free) {  // whatever the parent's orientation is
    rest.dw.setZero();
    rest.ww.setZero();
    rest.gw.setZero();
    return rest;
  }
  const Matrix3d wq = own.ww * link.axes;
  rest.dw -= dq * link.inverse * wq.transpose();
  rest.ww -= wq * link.inverse * wq.transpose();
  rest.gw -= wq * (link.inverse * gq);
  return rest;
}

// One step of all bones, from the roots to the tips; the largest turn, or shift of a root as a
// share of the body's size.
double PoseSolver::take_step(double relative_damping) {
  const double damping = relative_damping * size_ * size_;
  find_costs(damping);
  double largest = 0;
  for (Link& link : links_) largest = std::max(largest, find_motion(link));
  for (Link& link : links_) {
    if (link.freedom == Freedom::any) link.pose.turned = by(link.spin) * link.pose.turned;
    if (link.freedom == Freedom::about_axes) turn_about_axes(link);
    if (link.parent < 0) link.pose.travel += link.between.transpose() * link.move;
    carry(link);
  }
  return largest;
}

// The motion of a bone, given that of its parent.
double PoseSolver::find_motion(Link& link) const {
  link.move.setZero();
  link.spin.setZero();
  double largest = 0;
  if (link.parent >= 0) {
    const Link& parent = links_[static_cast<std::size_t>(link.parent)];
    link.spin = parent.spin;
    link.move = parent.move + parent.spin.cross(link.pose.base - parent.pose.base);
  } else if (link.travels && link.is_active && link.limb_is_seen) {
    link.move = root_motion(link);
    largest = link.move.norm() / size_;
  }
  if (link.freedom == Freedom::none || !link.limb_is_seen) return largest;
  const Cost& own = link.cost;
  const Vector3d spin = link.freedom == Freedom::any ? Vector3d::Zero() : link.spin;
  link.turns = -link.inverse *
               (link.axes.transpose() * (own.dw.transpose() * link.move + own.ww * spin + own.gw));
  link.spin = spin + link.axes * link.turns;
  return std::max(largest, link.turns.norm());
}

// Along the axes of the translation channels that there are.
Vector3d PoseSolver::root_motion(const Link& link) const {
  Matrix3d along = Matrix3d::Zero();
  for (const Channel channel : link.channels)
    if (is_translation(channel)) along.col(axis_of(channel)) = link.between.col(axis_of(channel));
  const Cost& rest = link.rest;
  Matrix3d costs = along.transpose() * rest.dd * along;
  for (int axis = 0; axis < 3; ++axis)
    if (along.col(axis).isZero(0)) costs(axis, axis) = 1;
  return -along * costs.ldlt().solve(along.transpose() * rest.gd);
}

void PoseSolver::turn_about_axes(Link& link) const {
  link.pose.local.setIdentity();
  std::size_t count = 0;
  for (const Channel channel : link.channels) {
    if (is_translation(channel)) continue;
    link.pose.angles[count] += link.turns[static_cast<Index>(count)];
    link.pose.local = link.pose.local * about(axis_of(channel), link.pose.angles[count++]);
  }
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
        if (link.freedom != Freedom::none) put(place, angles[turns++], unchanged);
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
