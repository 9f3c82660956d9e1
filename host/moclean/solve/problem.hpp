#pragma once

#include <span>

#include "moclean/core/segment_batch.hpp"
#include "moclean/solve/motion_prior.hpp"

namespace moclean {

/// What a backend is given: the samples of all segments, and what is known beside them. It refers
/// to both, which outlive it.
struct Problem {
  /// Implicit: a batch alone is a problem of which nothing else is known.
  Problem(const SegmentBatch& samples, std::span<const MotionPrior> known = {})
      : data(samples), priors(known) {}

  /// What is known of segment b; nothing where there are no priors.
  const MotionPrior& prior(Index b) const {
    static const MotionPrior none;
    return priors.empty() ? none : priors[static_cast<std::size_t>(b)];
  }

  const SegmentBatch& data;             ///< D, NaN where missing
  std::span<const MotionPrior> priors;  ///< one per segment, or none at all
};

}  // namespace moclean
