#pragma once

#include <Eigen/Core>

#include "moclean/core/matrix.hpp"

namespace moclean {

// Statistics of one window for MatrixNormal. Data is [frames x columns], NaN where missing; joints
// are runs of `joint_columns` neighbouring columns, the last may be shorter.

/// Three robust deviations of a column, the median over columns; where that is 0 the largest
/// magnitude, and above 0 in any case.
double column_scale(const ConstMatrixRef& data);

/// Deviation of noise that is in most samples, from the lower quartile of |fourth difference|:
/// motion and outliers lie above it. 0 if there are 50 or fewer such differences.
double dense_noise_level(const ConstMatrixRef& data);

/// Harmonic mean 2ab / (a + b) of the numbers of frames a, b from each sample to the nearest ones
/// before and after it whose weight is above 0.3: 1 between two neighbours. The ends of the window
/// count as three frames farther than they are.
Matrix gap_distance(const ConstMatrixRef& weights);

/// Raises every entry to the median over its joint's columns where that is larger.
void raise_to_joint_median(Matrix& energies, Index joint_columns);

}  // namespace moclean
