// Notation: a unit is a run of segments that the eigensolver takes at the same time, one to a lane;
// batches are runs of whole units.
#include "moclean/solve/opencl/batch_plan.hpp"

#include <algorithm>
#include <cmath>

namespace moclean::opencl {
namespace {

/// Share of the cache for the batches in flight. An iteration passes over all of a batch; from the
/// cache it takes a tenth less processor time than from main memory.
constexpr double cache_share = 0.75;

Index round_up(Index value, Index multiple) { return (value + multiple - 1) / multiple * multiple; }

/// How many units and batches there should be.
struct Division {
  Index units, batches;
};

Division divide(Index segments, double bytes_of_segment, const BatchBounds& bounds, int queues) {
  const double share = static_cast<double>(bounds.cache) / queues;
  const double room = std::min(cache_share * share, static_cast<double>(bounds.memory) / queues);
  const auto fitting = std::max(1.0, std::floor(room / bytes_of_segment));
  const auto lanes = static_cast<double>(bounds.lanes);
  // A unit that is not full costs as much as one that is: rather all of the cache than part of it.
  const bool lanes_fit = lanes * bytes_of_segment <= share;
  const auto unit = static_cast<Index>(lanes_fit ? lanes : std::min(fitting, lanes));
  // Fewer units than queues would leave cores idle while the eigensolver works on them.
  const Index needed = std::max((segments + unit - 1) / unit, std::min<Index>(segments, queues));
  const Index units = std::min(segments, round_up(needed, std::min<Index>(needed, queues)));
  const double most = std::max(1.0, std::floor(fitting / static_cast<double>(unit)));
  const auto batches = static_cast<Index>(std::ceil(static_cast<double>(units) / most));
  return {units, std::min(units, round_up(batches, std::min<Index>(units, queues)))};
}

/// First segment past the unit that segment b belongs to; units differ by one segment at most.
Index unit_end(Index b, Index segments, Index units) {
  const Index unit = ((b + 1) * units - 1) / segments;  // the largest that starts at b or before
  return (unit + 1) * segments / units;
}

/// First segment past the batch that starts with `first`, as far as the bounds permit; one always
/// is.
Index permitted_end(const std::vector<SegmentSize>& sizes, Index first, const BatchBounds& bounds,
                    std::uint64_t memory) {
  const Index most = bounds.segments > 0 ? bounds.segments : static_cast<Index>(sizes.size());
  std::uint64_t taken = 0, stacked = 0;
  Index last = first;
  for (; last < static_cast<Index>(sizes.size()) && last - first < most; ++last) {
    const SegmentSize& next = sizes[static_cast<std::size_t>(last)];
    taken += next.memory;
    stacked += next.stacked;
    if (last > first && (taken > memory || stacked > bounds.allocation)) break;
  }
  return last;
}

double bytes_of(const std::vector<SegmentSize>& sizes, Index first, Index last) {
  double bytes = 0;
  for (Index b = first; b < last; ++b)
    bytes += static_cast<double>(sizes[static_cast<std::size_t>(b)].memory);
  return bytes;
}

/// First segment past the batch that starts with `first` and has about `target` bytes.
Index desired_end(const std::vector<SegmentSize>& sizes, Index first, double target, Index units) {
  const auto segments = static_cast<Index>(sizes.size());
  double taken = 0;
  Index last = first;
  while (last < segments) {
    const Index end = unit_end(last, segments, units);
    const double next = bytes_of(sizes, last, end);
    if (last > first && taken + next / 2 > target) break;
    taken += next;
    last = end;
  }
  return last;
}

int permitted_queues(const std::vector<SegmentSize>& sizes, const BatchBounds& bounds) {
  const std::uint64_t largest = std::ranges::max(sizes, {}, &SegmentSize::memory).memory;
  const std::uint64_t fitting = bounds.memory / std::max<std::uint64_t>(1, largest);
  return static_cast<int>(std::min<std::uint64_t>(static_cast<std::uint64_t>(bounds.queues),
                                                  std::max<std::uint64_t>(1, fitting)));
}

}  // namespace

BatchPlan plan_batches(const std::vector<SegmentSize>& sizes, const BatchBounds& bounds) {
  BatchPlan plan;
  if (sizes.empty()) return plan;
  plan.queues = plan.permitted_queues = permitted_queues(sizes, bounds);
  const auto segments = static_cast<Index>(sizes.size());
  double left = bytes_of(sizes, 0, segments);
  const Division division =
      divide(segments, left / static_cast<double>(segments), bounds, plan.queues);
  const std::uint64_t memory = bounds.memory / static_cast<std::uint64_t>(plan.queues);
  while (plan.first.back() < segments) {
    const Index first = plan.first.back();
    const auto batches_left = std::max<Index>(1, division.batches - plan.batches());
    Index last = permitted_end(sizes, first, bounds, memory);
    if (bounds.segments == 0)
      last = std::min(last, desired_end(sizes, first, left / static_cast<double>(batches_left),
                                        division.units));
    left -= bytes_of(sizes, first, last);
    plan.first.push_back(last);
  }
  plan.queues = static_cast<int>(std::min<Index>(plan.queues, plan.batches()));
  return plan;
}

}  // namespace moclean::opencl
