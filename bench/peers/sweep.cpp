#include "peers/sweep.hpp"

#include <algorithm>

namespace moclean::peers {

double sweep(const Entries& entries, double lambda, double mu, double mu_next) {
  const double* __restrict D = entries.D;
  const double* __restrict A = entries.A;
  double* __restrict X = entries.X;
  double* __restrict Y = entries.Y;
  const double inverse = 1 / mu, both = 1 / mu + 1 / mu_next;
  double squares = 0;
#pragma GCC ivdep
  for (std::size_t i = 0; i < entries.count; ++i) {
    const double kept = A[i] - inverse * Y[i];
    const double y = std::min(std::max(mu * (D[i] - kept), -lambda), lambda);
    const double difference = y - Y[i];
    squares += difference * difference;
    X[i] = kept + both * y;
    Y[i] = y;
  }
  return squares * inverse * inverse;
}

}  // namespace moclean::peers
