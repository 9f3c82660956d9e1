#pragma once

#include <optional>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// Where a sample stands in a matrix, from 0.
struct SamplePlace {
  Index frame = 0;
  Index column = 0;
};

/// Largest magnitude of a sample that methods accept: sums of its squares stay finite.
inline constexpr double largest_entry = 1e140;

/// The first sample, frame by frame, that is infinite or larger than `largest` in magnitude, or NaN
/// unless missing ones are accepted; nothing if there is none.
std::optional<SamplePlace> first_unusable(const ConstMatrixRef& samples, bool missing_accepted,
                                          double largest);

}  // namespace moclean
