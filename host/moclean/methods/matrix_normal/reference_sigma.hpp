#pragma once

#include <Eigen/Core>

#include "moclean/core/matrix.hpp"
#include "moclean/methods/matrix_normal/reference_model.hpp"

namespace moclean::reference {

// Standard deviation of the cleaned motion by its definition (docs/decisions/sigma.md), in dense
// matrices; another text than methods/matrix_normal/deviation.hpp.

/// Of every entry of S, [frames x columns], after the last step; the eigenvectors of Q are the
/// rows of Z. NaN where there was no step.
Matrix deviation(const SmoothingState& state, const ConstMatrixRef& S, const Matrix& Z);

/// Diagonal of (diag(c) + ratio Delta' P Delta)^-1, [frames]: what smoothing leaves of white noise
/// of the variance 1 / c.
Eigen::VectorXd noise_left(const Eigen::VectorXd& confidence, const Eigen::VectorXd& precision,
                           double ratio);

/// Variance of every column's acceleration given those in use, for columns that are not, else 0:
/// the diagonal of the inverse of R among them.
Eigen::VectorXd variance_given(const Mask& used, const Matrix& R);

/// Accelerations less what those of the other joints predict, a_J - a_K Q_KK^-1 Q_KJ.
struct JointInnovations {
  Matrix values;             ///< [frames - 2 x columns]
  Eigen::VectorXd variance;  ///< under Q [columns]
};
JointInnovations joint_innovations(const Matrix& accelerations, const Matrix& Q,
                                   Index joint_columns);

/// Share of each of length + 2 innovations in the error at the middle of the gap that they span,
/// which is filled so that their squares are least.
Eigen::VectorXd shares_in_gap(Index length);

}  // namespace moclean::reference
