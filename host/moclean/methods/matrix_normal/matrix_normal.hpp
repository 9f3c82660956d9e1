#pragma once

#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

/// Robust smoothing under a matrix-normal model of motion: the accelerations (second differences
/// over the frames, rows of Delta S) are normal with a full covariance Q over all columns, learned
/// from the data itself, and a scale in every frame; samples have normal noise of deviation sigma,
/// and gross errors:
///   minimise  sum W_ij (D_ij - S_ij)^2 / (2 v_ij) + tr(P Delta S Q^-1 (Delta S)') / 2
/// where W is 0 for missing and rejected samples, and P diagonal; v is sigma^2 over the confidence
/// of the sample (MotionPrior), 1 where nothing is known of it. Q, P, sigma and W follow from S and
/// S from them, in turn: first `soft_steps` with Geman-McClure weights of a falling threshold and P
/// = 1, then `hard_steps` with rejection and an evidence update (MacKay 1992) of Q, P and sigma. No
/// singular values of the data are taken. Lengths scale: c D has the motion c S.
///
/// Missing samples (NaN) are filled. A column without any sample comes out as NaN.
struct MatrixNormal {
  static constexpr bool accepts_missing = true;
  static constexpr bool takes_prior = true;

  Index joint_columns = 3;    ///< neighbouring columns that fail together: x, y, z; at least 1
  Index median_frames = 7;    ///< window of the first guess, odd
  Index lag_frames = 8;       ///< of the differences that tell acceleration from noise, at least 1
  int soft_steps = 6;         ///< at least 1
  int hard_steps = 4;         ///< at least 1
  double soft_first = 8;      ///< threshold of the first soft step, predictive deviations, > 0
  double soft_last = 4;       ///< and of the last
  double hard = 6;            ///< samples farther than this are rejected, predictive deviations
  int solve_iterations = 10;  ///< most conjugate gradient iterations of a step, at least 1
  double soft_tolerance = 1e-5;  ///< of a soft step: on the residual, relative to that of S = 0
  double hard_tolerance = 1e-6;  ///< of a hard one

  /// Of the conjugate gradients of a step; the first guess is smoothed before step 0 as in it.
  double tolerance(int step) const { return step < soft_steps ? soft_tolerance : hard_tolerance; }

  bool operator==(const MatrixNormal&) const = default;

  static constexpr std::string_view name = "matrix-normal";
  static void visit(auto& self, auto& visitor) {
    visitor("joint-columns", self.joint_columns);
    visitor("median-frames", self.median_frames);
    visitor("lag-frames", self.lag_frames);
    visitor("soft-steps", self.soft_steps);
    visitor("hard-steps", self.hard_steps);
    visitor("soft-first", self.soft_first);
    visitor("soft-last", self.soft_last);
    visitor("hard", self.hard);
    visitor("solve-iterations", self.solve_iterations);
    visitor("soft-tolerance", self.soft_tolerance);
    visitor("hard-tolerance", self.hard_tolerance);
  }
};

/// Throws ArgumentError naming the first parameter out of its range.
void check(const MatrixNormal& method);

}  // namespace moclean
