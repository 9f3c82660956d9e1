#pragma once

#include <span>
#include <vector>

#include "moclean/segment/spans.hpp"

namespace moclean {

// A plan of K segments that costs least. Boundaries are those of 4 K equal parts, so that the equal
// division is one of the plans; a segment has 2 to 8 parts, half to twice the equal length.

inline constexpr Index parts_per_segment = 4;
inline constexpr Index fewest_parts = 2;
inline constexpr Index most_parts = 8;

/// Whether a take can be cut in other ways than equally: at least two segments, and four frames a
/// part.
bool can_vary(Index frames, Index segments);

/// All segments that a plan of `segments` may have, by their first frame, then by their last; about
/// 28 for each of the plan, with 35 times the take's frames. Throws ArgumentError unless
/// can_vary().
Spans candidate_segments(Index frames, Index segments);

/// The plan whose segments cost least in sum, by dynamic programming; `costs` are those of the
/// candidates, in their order, and at least 0. Each segment costs a millionth of the mean candidate
/// more for every part it differs from the equal length, squared: among plans as good as equal the
/// one with the most equal lengths is taken, and rounding does not choose. Throws ArgumentError
/// unless can_vary(), ShapeError for another number of costs, and ArgumentError for one that is
/// negative or not finite.
SegmentPlan cheapest_plan(Index frames, Index segments, std::span<const double> costs);

}  // namespace moclean
