#include "moclean/body/rigid_flags.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "moclean/body/edge_distances.hpp"
#include "moclean/body/taken_back.hpp"
#include "moclean/core/linear_fill.hpp"
#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr double vote = 0.4;
constexpr double weight_of_exact = 1.6;  // alone against a single other one it is not outvoted
constexpr double slow_seconds = 0.092, dense = 2e-3, least_spread = 1e-4;  // the last two: of size
constexpr double hole_share = 0.6;

using Row = Eigen::Array<double, 1, Eigen::Dynamic>;
using Marks = Eigen::Array<bool, 1, Eigen::Dynamic>;

// Which edges of a frame are off.
void compare(const EdgeDistances& d, const EdgeLimits& limits, Index frame, Marks& off) {
  off = d.both.row(frame) && (d.values.row(frame).array() - limits.centre).abs() > limits.limit;
}

// The votes of one frame, by joint.
class Votes {
 public:
  explicit Votes(const RigidBody& body)
      : body_(body), own_(body.testable.size()), share_(body.testable.size()) {
    for (std::size_t e = 0; e < body.edges.size(); ++e)
      for (const std::size_t j : ends(e)) own_[j].push_back(e);
  }

  // Votes out the joints of a frame one after the other, the worst first. `weight` is that of its
  // edges, 0 where an end was not seen; `off` tells the wrong ones.
  void vote_out(const Row& weight, const Marks& off, Index frame, Mask& bad) {
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

  // The share of a joint's edges between joints not voted out that are off, by weight.
  void count(std::size_t joint, const Marks& off) {
    double all = 0, wrong = 0;
    for (const std::size_t e : own_[joint]) {
      const auto edge = static_cast<Index>(e);
      all += left_(edge);
      if (off(edge)) wrong += left_(edge);
    }
    share_[joint] = all > 0 ? wrong / all : 0;
  }

  // Of the joints that can be tested; the number of joints if there is none.
  std::size_t largest_share() const {
    std::size_t worst = share_.size();
    for (std::size_t j = 0; j < share_.size(); ++j)
      if (body_.testable[j] && (worst == share_.size() || share_[j] > share_[worst])) worst = j;
    return worst;
  }

  const RigidBody& body_;
  std::vector<std::vector<std::size_t>> own_;  // edges of every joint
  std::vector<double> share_;
  Row left_;  // weights of the edges between joints that are not voted out
};

void vote_out_all(const RigidBody& body, const EdgeDistances& d, const EdgeLimits& limits,
                  Mask& bad) {
  Row weight = limits.limit.square().inverse();
  for (std::size_t e = 0; e < body.edges.size(); ++e)
    weight(static_cast<Index>(e)) *=
        body.edges[e].share * (body.edges[e].exact ? weight_of_exact : 1);
  Votes votes(body);
  Marks off(weight.size());
  for (Index i = 0; i < d.values.rows(); ++i) {
    compare(d, limits, i, off);
    if (off.any()) votes.vote_out(d.both.row(i).select(weight, 0), off, i, bad);
  }
}

// Running medians in the place of the distances, and limits that fit them.
EdgeLimits slow_down(const BodyTake& take, double size, EdgeDistances& d) {
  EdgeLimits limits(static_cast<std::size_t>(d.values.cols()));
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
    limits.limit(e) = off_deviations * std::max(core.spread, least_spread * size);
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

// The edges that tell of each joint: its exact ones, but all hard ones of a joint without any.
std::vector<std::vector<Index>> witnesses_of(const RigidBody& body) {
  const std::size_t joints = body.testable.size();
  std::vector<bool> has_exact(joints, false);
  for (const RigidEdge& edge : body.edges)
    for (const Index j : {edge.first, edge.second})
      if (edge.exact) has_exact[static_cast<std::size_t>(j)] = true;
  std::vector<std::vector<Index>> own(joints);
  for (std::size_t e = 0; e < body.edges.size(); ++e)
    for (const Index end : {body.edges[e].first, body.edges[e].second}) {
      const auto j = static_cast<std::size_t>(end);
      if (has_exact[j] ? body.edges[e].exact : body.edges[e].hard)
        own[j].push_back(static_cast<Index>(e));
    }
  return own;
}

void confirm(const RigidBody& body, const EdgeDistances& d, const EdgeLimits& limits,
             RigidFlags& flags) {
  constexpr Index enough = 2;
  const std::vector<std::vector<Index>> witnesses = witnesses_of(body);
  const auto linked =
      std::ranges::count_if(witnesses, [](const auto& own) { return !own.empty(); });
  Marks off(d.values.cols());
  for (Index i = 0; i < d.values.rows(); ++i) {
    compare(d, limits, i, off);
    for (std::size_t j = 0; j < witnesses.size(); ++j) {
      const auto& own = witnesses[j];
      const auto right =
          std::ranges::count_if(own, [&](Index e) { return d.both(i, e) && !off(e); });
      const bool wrong = std::ranges::any_of(own, [&](Index e) { return off(e); });
      const auto needed = std::clamp<Index>(static_cast<Index>(own.size()), 1, enough);
      const auto joint = static_cast<Index>(j);
      flags.consistent(i, joint) = right >= needed && !wrong;
      flags.confirmed(i, joint) = flags.consistent(i, joint) && !flags.bad(i, joint);
    }
    const bool most = 2 * flags.consistent.row(i).count() > linked;
    if (!most) flags.confirmed.row(i).setConstant(false);
  }
}

}  // namespace

RigidFlags vote_on_joints(const BodyTake& take, const RigidBody& body, double size, double smallest,
                          bool noise_is_white) {
  const Mask none = Mask::Constant(take.frames(), take.joints(), false);
  RigidFlags flags{none, none, none, {}};
  if (!body.is_rigid()) return flags;
  const EdgeDistances d = edge_distances(take, body.edges);
  EdgeLimits limits(body.edges.size());
  std::vector<double> spreads;
  for (std::size_t e = 0; e < body.edges.size(); ++e) {
    const RigidEdge& edge = body.edges[e];
    limits.centre(static_cast<Index>(e)) = edge.length;
    limits.limit(static_cast<Index>(e)) = off_deviations * std::max(edge.spread, smallest);
    spreads.push_back(edge.spread);
  }
  vote_out_all(body, d, limits, flags.bad);
  if (quantile(spreads, 0.1) > dense * size) {
    EdgeDistances slow = d;
    const EdgeLimits slow_limits = slow_down(take, size, slow);
    vote_out_all(body, slow, slow_limits, flags.bad);
  }
  close_holes(take, flags.bad);
  if (noise_is_white) flags.bones = noisy_bones(body, d, limits, flags.bad);
  Mask turned = none;
  if (flags.bones.empty()) turned = take_back_turning(take, body, d, limits, flags.bad);
  take_back_gradual(take, body, d, limits, smallest / noise_of_distance, flags.bad);
  if (!flags.bones.empty()) turned = turning_in_noise(flags.bad, flags.bones, flags.bones.largest);
  flags.bad = flags.bad && !turned;
  confirm(body, d, limits, flags);
  flags.confirmed = flags.confirmed || (turned && !flags.bad);
  return flags;
}

}  // namespace moclean
