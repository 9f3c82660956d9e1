// The steps of PoseSolver towards the least sum of squared distances.

#include <algorithm>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "moclean/motion/pose_solver.hpp"

namespace moclean {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

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

}  // namespace

// The world axes of a bone's rotation channels, in columns.
Matrix3d PoseSolver::axes_of(const Link& link) const {
  Matrix3d axes = Matrix3d::Zero(), turned = frame_of(link);
  Index count = 0;
  for (const Channel channel : link.channels) {
    if (is_translation(channel)) continue;
    axes.col(count) = turned.col(axis_of(channel));
    turned =
        turned * turn_about(axis_of(channel), link.pose.angles[static_cast<std::size_t>(count++)]);
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
    link.pose.local = link.pose.local * turn_about(axis_of(channel), link.pose.angles[count++]);
  }
}

}  // namespace moclean
