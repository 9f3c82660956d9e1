#pragma once

#include <stop_token>

#include "moclean/core/matrix.hpp"
#include "moclean/methods/robust_pca/robust_pca.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::reference {

/// One segment solved: data = low_rank + sparse up to the residual.
struct RobustPcaSolution {
  Matrix low_rank;  ///< A
  Matrix sparse;    ///< E
  Matrix
      multipliers;  ///< Y after the last iteration: the dual solution, a certificate of optimality
  SegmentOutcome outcome;
};

/// Robust PCA of one segment [rows x columns] by inexact augmented Lagrange multipliers, in double,
/// with the singular value decomposition of the iterate itself. It says what is right: other
/// backends are compared with it. Entries of `data` are finite, or NaN where
/// they were not observed, where E is 0; `method` passed check(). A segment of norm
/// zero is solved by A = E = 0 without an iteration. Throws Cancelled soon after `stop` is
/// requested.
RobustPcaSolution solve(const ConstMatrixRef& data, const RobustPca& method,
                        const std::stop_token& stop = {});

}  // namespace moclean::reference
