#pragma once

#include <stop_token>

#include "moclean/core/matrix.hpp"
#include "moclean/methods/matrix_completion/matrix_completion.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::reference {

/// One segment completed.
struct CompletionSolution {
  Matrix low_rank;  ///< A = X
  Matrix sparse;    ///< E = P(D - X)
  SegmentOutcome outcome;
};

/// Low-rank completion of one segment [rows x columns], NaN where it was not observed. A segment
/// that is zero wherever it was observed, or was not observed at all, is solved by A = E = 0
/// without an iteration. Throws Cancelled soon after `stop` is requested.
CompletionSolution solve(const ConstMatrixRef& data, const MatrixCompletion& method,
                         const std::stop_token& stop = {});

}  // namespace moclean::reference
