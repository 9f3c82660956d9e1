#pragma once

#include <stop_token>

#include "moclean/core/matrix.hpp"
#include "moclean/methods/spectral/weights.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::reference {

/// One segment split: data = low_rank + sparse.
struct SpectralSolution {
  Matrix low_rank;  ///< A
  Matrix sparse;    ///< E = D - A
  SegmentOutcome outcome;
};

/// A = U diag(f sigma) V' for one segment [rows x columns], from its singular value decomposition.
/// A segment of norm zero takes no iteration, any other one. `data` is finite.
SpectralSolution solve(const ConstMatrixRef& data, const TruncatedSvd& method,
                       const std::stop_token& stop = {});
SpectralSolution solve(const ConstMatrixRef& data, const SingularValueThresholding& method,
                       const std::stop_token& stop = {});

}  // namespace moclean::reference
