#pragma once

#include <algorithm>
#include <cmath>

#include "support/matrix.hpp"

namespace moclean::test {

/// (diag(w) + q Delta'Delta) x = b, Delta the difference of order `width` over the rows.
struct BandSystem {
  Eigen::VectorXd weights, b;
  double penalty = 0;
  int width = 2;
};

/// Weights of 0.1 to 1 and a right-hand side of size one.
inline BandSystem band_system(Index rows, double penalty, int width, std::uint64_t seed = 1) {
  Random random(seed);
  BandSystem system{Eigen::VectorXd(rows), Eigen::VectorXd(rows), penalty, width};
  for (double& w : system.weights) w = 0.1 + 0.9 * random.uniform();
  for (double& b : system.b) b = random.normal();
  return system;
}

/// Delta'Delta x in extended precision, by differences of differences.
inline std::vector<long double> penalised(const Eigen::VectorXd& x, int width) {
  std::vector<long double> d(x.begin(), x.end());
  if (x.size() <= width) return std::vector<long double>(d.size(), 0);
  for (int k = 0; k < width; ++k) {
    for (std::size_t i = 0; i + 1 < d.size(); ++i) d[i] = d[i + 1] - d[i];
    d.pop_back();
  }
  for (int k = 0; k < width; ++k) {  // the transpose: (D'v)_i = v_(i - 1) - v_i
    d.push_back(0);
    for (std::size_t i = d.size(); i-- > 0;) d[i] = (i > 0 ? d[i - 1] : 0) - d[i];
  }
  return d;
}

/// |b - A x| / (|A| |x| + |b|) in largest magnitudes, A by an upper bound of its row sums.
inline double backward_error(const BandSystem& system, const Eigen::VectorXd& x) {
  const std::vector<long double> y = penalised(x, system.width);
  long double worst = 0;
  for (Index i = 0; i < x.size(); ++i)
    worst = std::max(worst, std::abs(system.b(i) - system.weights(i) * (long double)(x(i)) -
                                     system.penalty * y[static_cast<std::size_t>(i)]));
  const double norm = system.weights.maxCoeff() + system.penalty * std::pow(4, system.width);
  return static_cast<double>(worst) /
         (norm * x.cwiseAbs().maxCoeff() + system.b.cwiseAbs().maxCoeff());
}

}  // namespace moclean::test
