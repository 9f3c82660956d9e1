#include "moclean/segment/cheapest_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

constexpr Index least_frames_per_part = 4;
constexpr double cost_of_inequality = 1e-6;  // of the mean cost, per part and squared

void require_variable(Index frames, Index segments) {
  if (!can_vary(frames, segments))
    throw ArgumentError(
        fmt::format("{} frames cannot be cut into {} segments but equally", frames, segments));
}

Index last_part(Index first, Index parts) { return std::min(first + most_parts, parts); }

void require_costs(std::span<const double> costs, std::size_t candidates) {
  if (costs.size() != candidates)
    throw ShapeError(fmt::format("{} costs for {} segments", costs.size(), candidates));
  for (const double cost : costs)
    if (!(cost >= 0) || !std::isfinite(cost))
      throw ArgumentError(fmt::format("a segment costs {}, expected a number from 0", cost));
}

// The least cost of cutting the first `part` parts into k segments, for one k.
struct Stage {
  std::vector<double> cost;
  std::vector<Index> from;  // the last segment's first part

  explicit Stage(Index parts)
      : cost(static_cast<std::size_t>(parts) + 1, std::numeric_limits<double>::infinity()),
        from(cost.size(), -1) {}
};

// One segment more than `before`. Of equal costs the earliest boundary is taken.
Stage extended(const Stage& before, Index parts, std::span<const double> costs) {
  Stage next(parts);
  auto cost = costs.begin();
  for (Index first = 0; first < parts; ++first)
    for (Index last = first + fewest_parts; last <= last_part(first, parts); ++last) {
      const auto to = static_cast<std::size_t>(last);
      const double sum = before.cost[static_cast<std::size_t>(first)] + *cost++;
      if (sum < next.cost[to]) {
        next.cost[to] = sum;
        next.from[to] = first;
      }
    }
  return next;
}

std::vector<double> with_inequality(Index parts, std::span<const double> costs) {
  std::vector<double> result(costs.begin(), costs.end());
  const double mean =
      std::reduce(result.begin(), result.end()) / static_cast<double>(result.size());
  const double unit = cost_of_inequality * (mean > 0 ? mean : 1);
  auto cost = result.begin();
  for (Index first = 0; first < parts; ++first)
    for (Index last = first + fewest_parts; last <= last_part(first, parts); ++last) {
      const auto apart = static_cast<double>(last - first - parts_per_segment);
      *cost++ += unit * apart * apart;
    }
  return result;
}

}  // namespace

bool can_vary(Index frames, Index segments) {
  return segments >= 2 && frames / segments >= parts_per_segment * least_frames_per_part;
}

Spans candidate_segments(Index frames, Index segments) {
  require_variable(frames, segments);
  const Index parts = parts_per_segment * segments;
  const SegmentPlan grid = equal_segments(frames, parts);
  Spans candidates;
  for (Index first = 0; first < parts; ++first)
    for (Index last = first + fewest_parts; last <= last_part(first, parts); ++last)
      candidates.push_back(
          {grid[static_cast<std::size_t>(first)], grid[static_cast<std::size_t>(last)]});
  return candidates;
}

SegmentPlan cheapest_plan(Index frames, Index segments, std::span<const double> costs) {
  require_costs(costs, candidate_segments(frames, segments).size());
  const Index parts = parts_per_segment * segments;
  const std::vector<double> all_costs = with_inequality(parts, costs);
  std::vector<Stage> stages = {Stage(parts)};
  stages.front().cost.front() = 0;
  for (Index k = 0; k < segments; ++k) stages.push_back(extended(stages.back(), parts, all_costs));

  const SegmentPlan grid = equal_segments(frames, parts);
  SegmentPlan plan = {frames};
  Index part = parts;
  for (auto stage = stages.rbegin(); part > 0; ++stage) {
    part = stage->from[static_cast<std::size_t>(part)];
    plan.push_back(grid[static_cast<std::size_t>(part)]);
  }
  std::ranges::reverse(plan);
  return plan;
}

}  // namespace moclean
