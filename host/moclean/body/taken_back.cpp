#include "moclean/body/taken_back.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "moclean/body/run_edges.hpp"

namespace moclean {
namespace {

constexpr double mean_deviations = 4, last_digit = 2e-3;  // of an exact distance
constexpr double mean_deviations_in_noise = 3;
constexpr double spared_share = 0.9, spared_seconds = 0.04;
constexpr Index shortest_in_noise = 4;  // frames: fewer are near a length by chance
constexpr double most_chance = 0.35;    // of a gross error to be near a length
constexpr double share_of_turns = 0.4;  // of marked samples
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

using Column = Eigen::Array<bool, Eigen::Dynamic, 1>;
using ConstColumn = Eigen::Ref<const Column>;

// Frames [first, last) in which a joint is flagged.
struct Run {
  Index joint, first, last;

  Index frames() const { return last - first; }
  auto of(auto&& column) const { return column.segment(first, frames()); }
};

std::vector<Run> runs_of(const Mask& flags, Index joint) {
  std::vector<Run> found;
  for (Index first = 0, last = 0; first < flags.rows(); first = last) {
    last = first + 1;
    if (!flags(first, joint)) continue;
    while (last < flags.rows() && flags(last, joint)) ++last;
    found.push_back({joint, first, last});
  }
  return found;
}

// An edge's distances less its length, as seen from one of its ends.
struct Witness {
  const RigidEdge* edge;
  Index joint;
  Eigen::ArrayXd off;
  Column seen;  // both ends, and the other is not voted out
  double limit;

  Witness(const RigidBody& body, const EdgeDistances& d, const EdgeLimits& limits, Index e,
          Index end, const Mask& out)
      : edge(&body.edges[static_cast<std::size_t>(e)]),
        joint(end),
        off(d.values.col(e).array() - limits.centre(e)),
        seen(d.both.col(e) && !out.col(edge->first == end ? edge->second : edge->first)),
        limit(limits.limit(e)) {}

  Column right() const { return seen && off.abs() <= limit; }
};

// Takes back what exact distances speak against.
Mask turning_about(const RigidBody& body, const EdgeDistances& d, const EdgeLimits& limits,
                   Index shortest, Mask& bad) {
  const Mask out = bad;
  Mask turned = Mask::Constant(bad.rows(), bad.cols(), false);
  const auto look = [&](const Witness& witness) {
    const Column right = witness.right();
    const double digits =
        mean_deviations * std::max(witness.edge->spread, last_digit * witness.limit);
    for (const Run& run : runs_of(out, witness.joint)) {
      const auto kept = run.of(right);
      const Index seen = run.of(witness.seen).count();
      const auto least = spared_share * static_cast<double>(seen);
      if (seen < shortest || static_cast<double>(kept.count()) < least) continue;
      auto flags = bad.col(run.joint).segment(run.first, run.frames());
      flags = flags && !kept;
      auto turns = turned.col(run.joint).segment(run.first, run.frames());
      const double mean =
          run.of(witness.seen).select(run.of(witness.off), 0).sum() / static_cast<double>(seen);
      if (std::abs(mean) <= digits) turns = turns || kept;
    }
  };
  for (std::size_t e = 0; e < body.edges.size(); ++e)
    if (const RigidEdge& edge = body.edges[e]; edge.exact)
      for (const Index end : {edge.first, edge.second})
        look({body, d, limits, static_cast<Index>(e), end, out});
  return turned;
}

// Samples that an exact distance says are wrong, or its other end.
Mask accused_of(const RigidBody& body, const EdgeDistances& d, const EdgeLimits& limits,
                const Mask& bad) {
  Mask accused = Mask::Constant(bad.rows(), bad.cols(), false);
  for (std::size_t e = 0; e < body.edges.size(); ++e) {
    if (!body.edges[e].exact) continue;
    const auto k = static_cast<Index>(e);
    const Column off =
        d.both.col(k) && (d.values.col(k).array() - limits.centre(k)).abs() > limits.limit(k);
    for (const Index j : {body.edges[e].first, body.edges[e].second})
      accused.col(j) = accused.col(j) || off;
  }
  return accused;
}

}  // namespace

NoisyBones noisy_bones(const RigidBody& body, const EdgeDistances& d, const EdgeLimits& limits,
                       const Mask& out) {
  if (std::ranges::any_of(body.edges, &RigidEdge::exact)) return {};
  const Index frames = out.rows(), joints = out.cols();
  NoisyBones bones{Matrix::Constant(frames, joints, missing), Matrix::Zero(frames, joints), {}, {}};
  bones.noise.setZero(joints);
  bones.chances.setZero(joints);
  std::vector<double> least(static_cast<std::size_t>(joints), 1);
  for (std::size_t e = 0; e < body.edges.size(); ++e) {
    if (!body.edges[e].hard) continue;
    for (const Index j : {body.edges[e].first, body.edges[e].second}) {
      const Witness witness(body, d, limits, static_cast<Index>(e), j, out);
      const Column right = witness.right(), usual = right && !out.col(j);
      if (!usual.any()) continue;
      const double noise = witness.limit / off_deviations;
      const double centre = usual.select(witness.off, 0).sum() / static_cast<double>(usual.count());
      const Eigen::ArrayXd off = (witness.off - centre) / noise;
      auto largest = bones.largest.col(j).array();
      largest = largest.max(witness.seen.select(off.abs(), 0));
      ++bones.chances(j);
      const double share =
          1 - static_cast<double>(right.count()) / static_cast<double>(witness.seen.count());
      if (share >= least[static_cast<std::size_t>(j)]) continue;
      least[static_cast<std::size_t>(j)] = share;
      bones.off.col(j) = witness.seen.select(off, missing);
      bones.noise(j) = noise;
    }
  }
  return bones;
}

Mask turning_in_noise(const Mask& runs, const NoisyBones& bones, const Matrix& displaced) {
  Mask turned = Mask::Constant(runs.rows(), runs.cols(), false);
  Index all = 0;
  for (Index j = 0; j < runs.cols(); ++j) {
    if (bones.chances(j) == 0) continue;
    for (const Run& run : runs_of(runs, j)) {
      all += run.frames();
      const auto own = run.of(bones.off.col(j).array());
      const auto seen = !own.isNaN();
      if (seen.count() < shortest_in_noise) continue;
      const auto off = seen.select(own, 0);
      const double mean = std::abs(off.sum()) / static_cast<double>(seen.count());
      const double most = mean_deviations_in_noise / std::sqrt(static_cast<double>(seen.count()));
      const double chance = bones.chances(j) * most / run.of(displaced.col(j)).mean();
      if (mean <= most && off.abs().maxCoeff() <= off_deviations && chance <= most_chance)
        turned.col(j).segment(run.first, run.frames()).setConstant(true);
    }
  }
  if (static_cast<double>(turned.count()) < share_of_turns * static_cast<double>(all))
    turned.setConstant(false);
  return turned;
}

Mask take_back_turning(const BodyTake& take, const RigidBody& body, const EdgeDistances& d,
                       const EdgeLimits& limits, Mask& bad) {
  return turning_about(body, d, limits, odd_frames(spared_seconds, take.frame_rate), bad);
}

void take_back_gradual(const BodyTake& take, const RigidBody& body, const EdgeDistances& d,
                       const EdgeLimits& limits, double noise, Mask& bad) {
  const Mask out = bad, accused = accused_of(body, d, limits, bad);
  for (Index j = 0; j < bad.cols(); ++j)
    for (const Run& run : runs_of(out, j)) {
      if (2 * run.of(accused.col(j)).count() >= run.frames()) continue;
      if (!has_edge(take, out, j, run.first, run.last, noise))
        bad.col(j).segment(run.first, run.frames()).setConstant(false);
    }
}

}  // namespace moclean
