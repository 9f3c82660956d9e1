#pragma once

#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// Boundaries of the segments of one take: segment s owns frames plan[s] up to plan[s + 1].
/// The first entry is 0, the last the number of frames; no segment is empty.
using SegmentPlan = std::vector<Index>;

/// `segments` equal parts: boundary s is floor(frames s / segments).
/// More segments than frames become one segment per frame. Throws ArgumentError if frames or
/// segments is less than 1.
SegmentPlan equal_segments(Index frames, Index segments);

/// Equal parts of about `length` frames: K = max(1, floor(frames / length + 0.5)) of them.
/// A take is never cut into full segments and a short rest: a short tail ruins the result
/// (a 2-frame tail triples the FD of the paper's takes). Throws ArgumentError if frames or length
/// is less than 1.
SegmentPlan segments_of_length(Index frames, Index length);

}  // namespace moclean
