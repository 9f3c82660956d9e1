#pragma once

#include "moclean/core/matrix.hpp"

namespace moclean {

/// Root mean square of estimate - truth over the entries where `mask` is `claim` and neither is
/// NaN; NaN where there is none. All three are [frames x columns], else ShapeError.
double rmse_where(const ConstMatrixRef& truth, const ConstMatrixRef& estimate, const Mask& mask,
                  bool claim);

/// How well the entries a method took for errors are those that noise had touched.
struct Detection {
  Index hits = 0;          ///< touched and found
  Index false_alarms = 0;  ///< found, but not touched
  Index misses = 0;        ///< touched, but not found

  double precision() const;  ///< hits of those found; NaN if none was found
  double recall() const;     ///< hits of those touched; NaN if none was touched
  double f1() const;         ///< harmonic mean 2 hits / (touched + found); NaN if both are none
};

/// Compares `touched`, the ground truth, with the entries of |E| above `threshold` (in the clip's
/// unit); both [frames x columns], else ShapeError. The default 0 is E != 0, which suits a sparse
/// E; filters and truncated decompositions leave hardly an entry of E at exactly zero. NaN entries
/// of E take no part.
Detection detection(const Mask& touched, const ConstMatrixRef& outliers, double threshold = 0);

}  // namespace moclean
