#include "moclean/body/jump_flags.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace moclean {
namespace {

constexpr double match = 0.35, shortest_seconds = 0.05, longest_seconds = 2;

// A run of sudden steps: from the frame `before` to the frame `after` by `way`.
struct Jump {
  Index before, after;
  Eigen::RowVector3d way;
};

std::vector<Jump> jumps_of(const SuddenSteps& steps) {
  std::vector<Jump> jumps;
  for (std::size_t i = 0; i < steps.sudden.size(); ++i) {
    if (!steps.sudden[i]) continue;
    const auto step = static_cast<Index>(i);
    if (i == 0 || !steps.sudden[i - 1]) jumps.push_back({step, step, Eigen::RowVector3d::Zero()});
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

Mask jump_flags(const BodyTake& take, std::span<const SuddenSteps> steps, const RigidBody& body) {
  Mask flags = Mask::Constant(take.frames(), take.joints(), false);
  for (Index j = 0; j < take.joints(); ++j) {
    const auto jumps = jumps_of(steps[static_cast<std::size_t>(j)]);
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
