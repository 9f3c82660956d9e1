#include "moclean/body/rigid_flags.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "moclean/core/linear_fill.hpp"
#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr double cut = 5, vote = 0.4;
constexpr double slow_seconds = 0.092, dense = 2e-3, least_spread = 1e-4;  // the last two: of size
constexpr double hole_share = 0.6;

// Distances of the edges, [frames x edges], and where both ends were seen.
struct Distances {
  Matrix values;
  Mask both;
};

Distances distances(const BodyTake& take, std::span<const RigidEdge> edges) {
  const auto count = static_cast<Index>(edges.size());
  Distances d{Matrix(take.frames(), count), Mask(take.frames(), count)};
  for (Index i = 0; i < take.frames(); ++i)
    for (Index e = 0; e < count; ++e) {
      const auto& [first, second, length, spread, hard, exact] = edges[static_cast<std::size_t>(e)];
      d.both(i, e) = take.seen(i, first) && take.seen(i, second);
      d.values(i, e) = (take.position(i, first) - take.position(i, second)).norm();
    }
  return d;
}

// Centres and limits to compare distances with, one per edge.
struct Limits {
  std::vector<double> centre, limit;
};

bool is_off(const Distances& d, const Limits& limits, Index frame, std::size_t edge) {
  const auto e = static_cast<Index>(edge);
  return d.both(frame, e) &&
         std::abs(d.values(frame, e) - limits.centre[edge]) > limits.limit[edge];
}

// The votes of one frame: per joint the weight of its edges, and of those that are off.
struct Votes {
  std::vector<double> all, wrong;

  double share(std::size_t joint) const { return all[joint] > 0 ? wrong[joint] / all[joint] : 0; }
};

// Blames the joints of one frame one after the other, the worst first.
void blame(const RigidBody& body, const std::vector<double>& weight, std::vector<bool> off,
           Index frame, Mask& bad) {
  const std::size_t joints = body.judged.size();
  std::vector<double> left = weight;  // of the edges between joints that are not blamed
  for (std::size_t round = 0; round + 3 < joints; ++round) {
    Votes votes{std::vector<double>(joints, 0), std::vector<double>(joints, 0)};
    for (std::size_t e = 0; e < left.size(); ++e)
      for (const Index j : {body.edges[e].first, body.edges[e].second}) {
        votes.all[static_cast<std::size_t>(j)] += left[e];
        if (off[e]) votes.wrong[static_cast<std::size_t>(j)] += left[e];
      }
    std::size_t worst = joints;
    for (std::size_t j = 0; j < joints; ++j)
      if (body.judged[j] && (worst == joints || votes.share(j) > votes.share(worst))) worst = j;
    if (worst == joints || votes.share(worst) <= vote) return;
    bad(frame, static_cast<Index>(worst)) = true;
    for (std::size_t e = 0; e < left.size(); ++e)
      if (std::cmp_equal(body.edges[e].first, worst) || std::cmp_equal(body.edges[e].second, worst))
        left[e] = 0;
  }
}

void blame_all(const RigidBody& body, const Distances& d, const Limits& limits, Mask& bad) {
  std::vector<double> weight(body.edges.size());
  std::vector<bool> off(body.edges.size());
  for (Index i = 0; i < d.values.rows(); ++i) {
    bool any = false;
    for (std::size_t e = 0; e < weight.size(); ++e) {
      weight[e] = d.both(i, static_cast<Index>(e)) ? 1 / (limits.limit[e] * limits.limit[e]) : 0;
      off[e] = is_off(d, limits, i, e);
      any = any || off[e];
    }
    if (any) blame(body, weight, off, i, bad);
  }
}

// Running medians in the place of the distances, and limits that fit them.
Limits slow_down(const BodyTake& take, double size, Distances& d) {
  Limits limits;
  std::vector<double> channel(static_cast<std::size_t>(take.frames())), seen;
  for (Index e = 0; e < d.values.cols(); ++e) {
    Eigen::Map<Eigen::VectorXd> values(channel.data(), take.frames());
    values = d.values.col(e);
    fill_linearly(channel, d.both.col(e));
    running_median(channel, odd_frames(slow_seconds, take.frame_rate, 5));
    d.values.col(e) = values;
    seen.clear();
    for (Index i = 0; i < take.frames(); ++i)
      if (d.both(i, e)) seen.push_back(values(i));
    const Core core = steady_core(seen);
    limits.centre.push_back(core.centre);
    limits.limit.push_back(cut * std::max(core.spread, least_spread * size));
  }
  return limits;
}

// Flags what is flagged in most of the frames around it.
void close_holes(const BodyTake& take, Mask& bad) {
  const Index half = odd_frames(slow_seconds, take.frame_rate, 5) / 2;
  const Mask before = bad;
  for (Index j = 0; j < bad.cols(); ++j)
    for (Index i = 0; i < bad.rows(); ++i) {
      const Index first = std::max<Index>(0, i - half), last = std::min(bad.rows(), i + half + 1);
      const auto flagged = before.col(j).segment(first, last - first).count();
      if (static_cast<double>(flagged) > hole_share * static_cast<double>(last - first))
        bad(i, j) = true;
    }
}

void vouch(const RigidBody& body, const Distances& d, const Limits& limits, RigidFlags& flags) {
  const std::size_t joints = body.judged.size();
  std::vector<int> degree(joints, 0), right(joints);
  std::vector<bool> wrong(joints);
  for (const RigidEdge& edge : body.edges)
    if (edge.hard)
      for (const Index j : {edge.first, edge.second}) ++degree[static_cast<std::size_t>(j)];
  for (Index i = 0; i < d.values.rows(); ++i) {
    std::ranges::fill(right, 0);
    std::fill(wrong.begin(), wrong.end(), false);
    for (std::size_t e = 0; e < body.edges.size(); ++e) {
      if (!body.edges[e].hard || !d.both(i, static_cast<Index>(e))) continue;
      const bool off = is_off(d, limits, i, e);
      for (const Index j : {body.edges[e].first, body.edges[e].second}) {
        right[static_cast<std::size_t>(j)] += !off;
        if (off) wrong[static_cast<std::size_t>(j)] = true;
      }
    }
    for (std::size_t j = 0; j < joints; ++j) {
      const auto joint = static_cast<Index>(j);
      flags.vouched(i, joint) = right[j] >= 2 && !wrong[j] && !flags.bad(i, joint);
      flags.consistent(i, joint) = right[j] >= std::clamp(degree[j], 1, 2) && !wrong[j];
    }
  }
}

}  // namespace

RigidFlags judge(const BodyTake& take, const RigidBody& body, double size, double smallest) {
  const Mask none = Mask::Constant(take.frames(), take.joints(), false);
  RigidFlags flags{none, none, none};
  if (!body.is_rigid()) return flags;
  Distances d = distances(take, body.edges);
  Limits limits;
  std::vector<double> spreads;
  for (const RigidEdge& edge : body.edges) {
    limits.centre.push_back(edge.length);
    limits.limit.push_back(cut * std::max(edge.spread, smallest));
    spreads.push_back(edge.spread);
  }
  blame_all(body, d, limits, flags.bad);
  if (quantile(spreads, 0.1) > dense * size) {
    Distances slow = d;
    const Limits slow_limits = slow_down(take, size, slow);
    blame_all(body, slow, slow_limits, flags.bad);
  }
  close_holes(take, flags.bad);
  vouch(body, d, limits, flags);
  return flags;
}

}  // namespace moclean
