#pragma once

#include <cstddef>

namespace moclean::peers {

/// What one sweep over entries of a segment reads and writes; `count` entries each, no overlap.
struct Entries {
  const double* D = nullptr;
  const double* A = nullptr;
  double* X = nullptr;
  double* Y = nullptr;
  std::size_t count = 0;
};

/// Shrinkage, dual update and next iterate in one pass over memory:
///   T = D - A + Y/mu   Y+ = clamp(mu T, -lambda, lambda)   X = A - Y/mu + Y+ (1/mu + 1/mu+)
/// where E = T - Y+/mu is never formed. Returns the sum of squares of D - A - E = (Y+ - Y)/mu.
double sweep(const Entries& entries, double lambda, double mu, double mu_next);

}  // namespace moclean::peers
