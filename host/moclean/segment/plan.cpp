#include "moclean/segment/plan.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

void require_positive(const char* name, Index value) {
  if (value < 1) throw ArgumentError(fmt::format("{} is {}, expected at least 1", name, value));
}

}  // namespace

SegmentPlan equal_segments(Index frames, Index segments) {
  require_positive("number of frames", frames);
  require_positive("number of segments", segments);
  segments = std::min(segments, frames);

  // floor(frames s / segments) without the product, which could overflow: the whole and the
  // fractional part of frames / segments are added up apart.
  const Index whole = frames / segments;
  const Index part = frames % segments;
  SegmentPlan plan = {0};
  plan.reserve(static_cast<std::size_t>(segments) + 1);
  Index remainder = 0;
  for (Index s = 0; s < segments; ++s) {
    remainder += part;
    const bool full = remainder >= segments;
    if (full) remainder -= segments;
    plan.push_back(plan.back() + whole + (full ? 1 : 0));
  }
  return plan;
}

SegmentPlan segments_of_length(Index frames, Index length) {
  require_positive("number of frames", frames);
  require_positive("segment length", length);

  const Index rest = frames % length;
  const bool at_least_half = rest >= length - rest;
  return equal_segments(frames, std::max<Index>(1, frames / length + (at_least_half ? 1 : 0)));
}

}  // namespace moclean
