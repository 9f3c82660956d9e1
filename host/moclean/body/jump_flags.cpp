#include "moclean/body/jump_flags.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "moclean/core/linear_fill.hpp"
#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr double trend_seconds = 0.075, speed_seconds = 0.125, local_seconds = 0.5;
constexpr double noise_share = 8, speed_share = 0.5, size_share = 0.1;
constexpr double match = 0.35, shortest_seconds = 0.05, longest_seconds = 2;

using Velocities = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

// The way of a joint where it is trusted, interpolated elsewhere: velocities, [frames - 1 x 3].
Velocities velocities_of(const BodyTake& take, const Mask& trusted, Index joint) {
  Velocities v(take.frames() - 1, 3);
  std::vector<double> channel(static_cast<std::size_t>(take.frames()));
  Eigen::Map<Eigen::VectorXd> values(channel.data(), take.frames());
  for (Index c = 0; c < 3; ++c) {
    values = take.positions.col(3 * joint + c);
    fill_linearly(channel, trusted.col(joint));
    v.col(c) = values.tail(v.rows()) - values.head(v.rows());
  }
  return v;
}

// Whether no step can be as long as a jump: neither a velocity nor a median of velocities is longer
// than the largest of every coordinate together.
bool is_slow(const Velocities& v, double size) {
  return 2 * v.cwiseAbs().colwise().maxCoeff().norm() < size_share * size;
}

// What the running median of the velocity leaves, and how fast the joint goes.
struct Steps {
  Velocities rest;
  std::vector<double> length, speed;  // |rest|, |trend|
};

Steps steps_of(const Velocities& v, double frame_rate) {
  Steps steps{.rest = v, .length = {}, .speed = {}};
  Velocities trend = v;
  std::vector<double> channel(static_cast<std::size_t>(v.rows()));
  for (Index c = 0; c < 3; ++c) {
    Eigen::Map<Eigen::VectorXd> values(channel.data(), v.rows());
    values = v.col(c);
    running_median(channel, odd_frames(trend_seconds, frame_rate));
    trend.col(c) = values;
  }
  steps.rest -= trend;
  for (Index i = 0; i < v.rows(); ++i) {
    steps.length.push_back(steps.rest.row(i).norm());
    steps.speed.push_back(trend.row(i).norm());
  }
  return steps;
}

// Frames whose step exceeds the threshold.
std::vector<bool> hot_steps(const Steps& steps, double frame_rate, double size) {
  std::vector<double> local = steps.length, sorted = steps.length;
  running_median(local, odd_frames(local_seconds, frame_rate));
  const double least = median(sorted) / 2;
  const auto reach = static_cast<std::size_t>(odd_frames(speed_seconds, frame_rate) / 2);
  std::vector<bool> hot(local.size());
  for (std::size_t i = 0; i < hot.size(); ++i) {
    const auto first = steps.speed.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, reach));
    const auto last =
        steps.speed.begin() + static_cast<std::ptrdiff_t>(std::min(hot.size(), i + reach + 1));
    const double bound = noise_share * std::max(local[i], least) +
                         speed_share * *std::max_element(first, last) + size_share * size;
    hot[i] = steps.length[i] > bound;
  }
  return hot;
}

// A run of hot steps: from the frame `before` to the frame `after` by `way`.
struct Jump {
  Index before, after;
  Eigen::RowVector3d way;
};

std::vector<Jump> jumps_of(const Steps& steps, const std::vector<bool>& hot) {
  std::vector<Jump> jumps;
  for (std::size_t i = 0; i < hot.size(); ++i) {
    if (!hot[i]) continue;
    const auto step = static_cast<Index>(i);
    if (i == 0 || !hot[i - 1]) jumps.push_back({step, step, Eigen::RowVector3d::Zero()});
    jumps.back().after = step + 1;
    jumps.back().way += steps.rest.row(step);
  }
  return jumps;
}

// The jump that takes jumps[k] back.
std::optional<std::size_t> way_back(const std::vector<Jump>& jumps, std::size_t k, double rate) {
  for (std::size_t q = k + 1; q < jumps.size(); ++q) {
    const auto frames = static_cast<double>(jumps[q].before + 1 - jumps[k].after);
    if (frames > longest_seconds * rate) return {};
    if (frames < std::max(shortest_seconds * rate, 2.0)) continue;
    const Eigen::RowVector3d &there = jumps[k].way, &home = jumps[q].way;
    if ((there + home).norm() < match * (there.norm() + home.norm())) return q;
  }
  return {};
}

}  // namespace

Mask jump_flags(const BodyTake& take, const Mask& trusted, const RigidBody& body, double size) {
  Mask flags = Mask::Constant(take.frames(), take.joints(), false);
  if (take.frames() < 3) return flags;
  for (Index j = 0; j < take.joints(); ++j) {
    const Velocities v = velocities_of(take, trusted, j);
    if (is_slow(v, size)) continue;
    const Steps steps = steps_of(v, take.frame_rate);
    const auto jumps = jumps_of(steps, hot_steps(steps, take.frame_rate, size));
    for (std::size_t k = 0; k < jumps.size(); ++k)
      if (const auto back = way_back(jumps, k, take.frame_rate)) {
        const Index first = jumps[k].before + 1;
        flags.col(j).segment(first, jumps[*back].after - first).setConstant(true);
        k = *back;
      }
  }
  Mask limbs = Mask::Constant(take.frames(), take.joints(), false);
  for (const RigidEdge& edge : body.edges) {
    if (!edge.hard) continue;
    const auto both = flags.col(edge.first) && flags.col(edge.second);
    limbs.col(edge.first) = limbs.col(edge.first) || both;
    limbs.col(edge.second) = limbs.col(edge.second) || both;
  }
  return limbs;
}

}  // namespace moclean
