#include "moclean/body/rigid_flags.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "moclean/core/linear_fill.hpp"
#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr double cut = 5, vote = 0.4;
constexpr double weight_of_exact = 1.6;  // alone against a single other one it is not outvoted
constexpr double slow_seconds = 0.092, dense = 2e-3, least_spread = 1e-4;  // the last two: of size
constexpr double hole_share = 0.6, spared_share = 0.9, spared_seconds = 0.04;

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
      const RigidEdge& edge = edges[static_cast<std::size_t>(e)];
      d.both(i, e) = take.seen(i, edge.first) && take.seen(i, edge.second);
      d.values(i, e) = (take.position(i, edge.first) - take.position(i, edge.second)).norm();
    }
  return d;
}

using Row = Eigen::Array<double, 1, Eigen::Dynamic>;
using Marks = Eigen::Array<bool, 1, Eigen::Dynamic>;
using Column = Eigen::Array<bool, Eigen::Dynamic, 1>;

// Centres and limits to compare distances with, one per edge.
struct Limits {
  explicit Limits(std::size_t edges)
      : centre(static_cast<Index>(edges)), limit(static_cast<Index>(edges)) {}

  Row centre, limit;
};

// Which edges of a frame are off.
void compare(const Distances& d, const Limits& limits, Index frame, Marks& off) {
  off = d.both.row(frame) && (d.values.row(frame).array() - limits.centre).abs() > limits.limit;
}

// The votes of one frame, by joint.
class Votes {
 public:
  explicit Votes(const RigidBody& body)
      : body_(body), own_(body.judged.size()), share_(body.judged.size()) {
    for (std::size_t e = 0; e < body.edges.size(); ++e)
      for (const std::size_t j : ends(e)) own_[j].push_back(e);
  }

  // Blames the joints of a frame one after the other, the worst first. `weight` is that of its
  // edges, 0 where an end was not seen; `off` tells the wrong ones.
  void blame(const Row& weight, const Marks& off, Index frame, Mask& bad) {
    left_ = weight;
    for (std::size_t j = 0; j < own_.size(); ++j) count(j, off);
    for (std::size_t round = 0; round + 3 < own_.size(); ++round) {
      const std::size_t worst = largest_share();
      if (worst == own_.size() || share_[worst] <= vote) return;
      bad(frame, static_cast<Index>(worst)) = true;
      for (const std::size_t e : own_[worst]) left_(static_cast<Index>(e)) = 0;
      for (const std::size_t e : own_[worst])
        for (const std::size_t j : ends(e)) count(j, off);
    }
  }

 private:
  std::array<std::size_t, 2> ends(std::size_t edge) const {
    return {static_cast<std::size_t>(body_.edges[edge].first),
            static_cast<std::size_t>(body_.edges[edge].second)};
  }

  // The share of a joint's edges between joints not blamed that are off, by weight.
  void count(std::size_t joint, const Marks& off) {
    double all = 0, wrong = 0;
    for (const std::size_t e : own_[joint]) {
      const auto edge = static_cast<Index>(e);
      all += left_(edge);
      if (off(edge)) wrong += left_(edge);
    }
    share_[joint] = all > 0 ? wrong / all : 0;
  }

  // Of the joints that can be judged; the number of joints if there is none.
  std::size_t largest_share() const {
    std::size_t worst = share_.size();
    for (std::size_t j = 0; j < share_.size(); ++j)
      if (body_.judged[j] && (worst == share_.size() || share_[j] > share_[worst])) worst = j;
    return worst;
  }

  const RigidBody& body_;
  std::vector<std::vector<std::size_t>> own_;  // edges of every joint
  std::vector<double> share_;
  Row left_;  // weights of the edges between joints that are not blamed
};

void blame_all(const RigidBody& body, const Distances& d, const Limits& limits, Mask& bad) {
  Row weight = limits.limit.square().inverse();
  for (std::size_t e = 0; e < body.edges.size(); ++e)
    weight(static_cast<Index>(e)) *=
        body.edges[e].share * (body.edges[e].exact ? weight_of_exact : 1);
  Votes votes(body);
  Marks off(weight.size());
  for (Index i = 0; i < d.values.rows(); ++i) {
    compare(d, limits, i, off);
    if (off.any()) votes.blame(d.both.row(i).select(weight, 0), off, i, bad);
  }
}

// Running medians in the place of the distances, and limits that fit them.
Limits slow_down(const BodyTake& take, double size, Distances& d) {
  Limits limits(static_cast<std::size_t>(d.values.cols()));
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
    limits.centre(e) = core.centre;
    limits.limit(e) = cut * std::max(core.spread, least_spread * size);
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

// Takes back flags that an exact distance to a joint without blame speaks against as long as they
// last: a joint that was moved keeps a distance by coincidence, for a frame or so; one that turned
// about the other keeps it. Returns the samples that were spared, [frames x joints].
Mask spare(const RigidBody& body, const Distances& d, const Limits& limits, Index shortest,
           Mask& bad) {
  const Mask blamed = bad;
  Mask spared = Mask::Constant(bad.rows(), bad.cols(), false);
  for (std::size_t e = 0; e < body.edges.size(); ++e) {
    const RigidEdge& edge = body.edges[e];
    if (!edge.exact) continue;
    const auto k = static_cast<Index>(e);
    const Column right =
        d.both.col(k) && (d.values.col(k).array() - limits.centre(k)).abs() <= limits.limit(k);
    for (const auto& [joint, other] :
         {std::pair(edge.first, edge.second), std::pair(edge.second, edge.first)}) {
      const Column witnessed = d.both.col(k) && !blamed.col(other), kept = witnessed && right;
      for (Index first = 0, last = 0; first < bad.rows(); first = last) {
        last = first + 1;
        if (!blamed(first, joint)) continue;
        while (last < bad.rows() && blamed(last, joint)) ++last;
        const auto run = kept.segment(first, last - first);
        const Index seen = witnessed.segment(first, last - first).count();
        if (seen < shortest ||
            static_cast<double>(run.count()) < spared_share * static_cast<double>(seen))
          continue;
        auto flags = bad.col(joint).segment(first, last - first);
        flags = flags && !run;
        spared.col(joint).segment(first, last - first) =
            spared.col(joint).segment(first, last - first) || run;
      }
    }
  }
  return spared;
}

void vouch(const RigidBody& body, const Distances& d, const Limits& limits, RigidFlags& flags) {
  const std::size_t joints = body.judged.size();
  std::vector<int> degree(joints, 0), right(joints);
  std::vector<bool> wrong(joints);
  for (const RigidEdge& edge : body.edges)
    if (edge.hard)
      for (const Index j : {edge.first, edge.second}) ++degree[static_cast<std::size_t>(j)];
  Marks off(d.values.cols());
  for (Index i = 0; i < d.values.rows(); ++i) {
    compare(d, limits, i, off);
    std::ranges::fill(right, 0);
    std::fill(wrong.begin(), wrong.end(), false);
    for (std::size_t e = 0; e < body.edges.size(); ++e) {
      const auto edge = static_cast<Index>(e);
      if (!body.edges[e].hard || !d.both(i, edge)) continue;
      for (const Index j : {body.edges[e].first, body.edges[e].second}) {
        right[static_cast<std::size_t>(j)] += !off(edge);
        if (off(edge)) wrong[static_cast<std::size_t>(j)] = true;
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
  Limits limits(body.edges.size());
  std::vector<double> spreads;
  for (std::size_t e = 0; e < body.edges.size(); ++e) {
    const RigidEdge& edge = body.edges[e];
    limits.centre(static_cast<Index>(e)) = edge.length;
    limits.limit(static_cast<Index>(e)) = cut * std::max(edge.spread, smallest);
    spreads.push_back(edge.spread);
  }
  blame_all(body, d, limits, flags.bad);
  if (quantile(spreads, 0.1) > dense * size) {
    Distances slow = d;
    const Limits slow_limits = slow_down(take, size, slow);
    blame_all(body, slow, slow_limits, flags.bad);
  }
  close_holes(take, flags.bad);
  const Mask spared =
      spare(body, d, limits, odd_frames(spared_seconds, take.frame_rate), flags.bad);
  vouch(body, d, limits, flags);
  flags.vouched = flags.vouched || spared;
  return flags;
}

}  // namespace moclean
