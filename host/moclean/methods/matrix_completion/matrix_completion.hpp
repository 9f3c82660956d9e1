#pragma once

#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

/// Low-rank completion of a matrix with missing entries (NaN) by iterated singular value
/// thresholding (Cai, Candes, Shen 2010, algorithm 1; for motion capture Lai, Yuen, Lee 2011):
///   minimise  tau |X|_* + |X|_F^2 / 2  subject to  X = D where D was observed.
/// With P the observed entries of a matrix (0 elsewhere), omega their number, m x n the size:
///   tau = threshold |P(D)|_F, delta = step m n / omega,
///   Y = ceil(tau / (delta |P(D)|_2)) delta P(D); then again and again
///   X = U max(sigma - tau, 0) V' with Y = U sigma V', Y = Y + delta P(D - X)
/// until |P(D - X)|_F <= tolerance |P(D)|_F. A = X, which fills the gaps; E = P(D - X).
///
/// The paper's delta is for entries missing at random; where most are missing by some rule it is
/// too long, and Y grows beyond all bounds. The iteration is gradient ascent on a dual function
/// whose gradient P(D - X) is nonexpansive in Y, so that no delta below 2 lets |P(D - X)|_F grow:
/// where it has grown, delta is 1.9 from then on, and the iteration converges.
///
/// The paper's tau is 5 sqrt(m n) for entries of size one, that is threshold = 5; a smaller one
/// takes fewer iterations and fills gaps worse below about 1. Sparse errors are taken for motion:
/// remove them first (`hampel+completion`). A column that was never observed comes out as zero.
struct MatrixCompletion {
  static constexpr bool accepts_missing = true;

  double threshold = 1;       ///< tau / |P(D)|_F, above 0, at most 1e6
  double step = 1.2;          ///< above 0, at most 1e6
  double tolerance = 3e-3;    ///< on |P(D - X)|_F / |P(D)|_F, above 0, at most 1e6
  int max_iterations = 2000;  ///< >= 1

  bool operator==(const MatrixCompletion&) const = default;

  static constexpr std::string_view name = "completion";
  static void visit(auto& self, auto& visitor) {
    visitor("threshold", self.threshold);
    visitor("step", self.step);
    visitor("tolerance", self.tolerance);
    visitor("max-iterations", self.max_iterations);
  }
};

/// Throws ArgumentError naming the first parameter out of its range.
void check(const MatrixCompletion& method);

/// What a segment's iteration starts from; the same bits on every backend.
struct CompletionStart {
  Matrix data;      ///< P(D), [rows x columns]
  Matrix observed;  ///< 1 where D was observed, else 0
  double norm = 0;  ///< |P(D)|_F
  double tau = 0;
  double delta = 0;

  /// First multiple of delta P(D), given |P(D)|_2: what Y starts as.
  double kick(double norm_2) const;
};

/// The delta of the next iteration, by |P(D - X)|_F after and before the last one.
double next_step(double delta, double after, double before);

CompletionStart start_completion(const ConstMatrixRef& data, const MatrixCompletion& method);

}  // namespace moclean
