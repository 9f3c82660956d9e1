#pragma once

#include <optional>
#include <vector>

#include "moclean/core/segment_batch.hpp"

namespace moclean {

/// How the solution of one segment came about.
struct SegmentOutcome {
  int iterations = 0;
  /// Singular values above the last threshold: of A, of L for tslra, of X for completion. Nothing
  /// where the method has none.
  std::optional<int> rank = 0;
  /// After the last iteration, over the observed entries: |D - A - E|_F / |D|_F of robust PCA, of
  /// tslra the larger of it and |L - S|_F / |D|_F, |D - A|_F / |D|_F of completion; 0 for a zero
  /// segment, and for methods of one step, which are exact.
  double residual = 0;
  bool converged = false;  ///< the residual has come down to the tolerance
  /// The method takes a fixed number of steps, whatever they achieve: it has no residual, and does
  /// not claim to have converged. Its iterations are those of its linear solver, in all steps.
  bool fixed_steps = false;
};

/// Whether an iteration to a tolerance ended before it got there.
inline bool fell_short(const SegmentOutcome& outcome) {
  return !outcome.converged && !outcome.fixed_steps;
}

/// D = low_rank + sparse, segment by segment, in the layout of the data; where D is NaN, sparse is
/// 0. Matrix-normal smoothing takes noise away besides, which is in neither.
struct Solution {
  SegmentBatch low_rank;  ///< A
  SegmentBatch sparse;    ///< E
  std::vector<SegmentOutcome> segments;
  // Of methods that tell, see tells_trust() in backend/method.hpp:
  std::optional<SegmentBatch> trusted = {};    ///< 1 where a sample was used, else 0
  std::optional<SegmentBatch> deviation = {};  ///< standard deviation of the motion
};

}  // namespace moclean
