#pragma once

#include <stop_token>

#include "moclean/core/matrix.hpp"
#include "moclean/methods/temporal_robust_pca/temporal_robust_pca.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::reference {

/// One segment split: data = low_rank + sparse up to the residual, where it was observed.
struct TemporalSolution {
  Matrix low_rank;     ///< A = S
  Matrix sparse;       ///< E, 0 where the data is missing
  Matrix multipliers;  ///< Y after the last iteration: 0 where missing, never beyond lambda
  SegmentOutcome outcome;
};

/// Robust PCA with a second-difference penalty of one segment [rows x columns], NaN where it was
/// not observed. A segment that is zero wherever it was observed, or was not observed at all, is
/// solved by A = E = 0 without an iteration. Throws Cancelled soon after `stop` is requested.
TemporalSolution solve(const ConstMatrixRef& data, const TemporalRobustPca& method,
                       const std::stop_token& stop = {});

}  // namespace moclean::reference
