#pragma once

#include <stop_token>

#include "moclean/core/matrix.hpp"
#include "moclean/methods/matrix_normal/matrix_normal.hpp"
#include "moclean/solve/motion_prior.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::reference {

/// Delta' diag(precision) Delta X, Delta the second difference over the rows, of which the last two
/// are none: precision [rows] is 0 there.
Matrix stiffness(const Matrix& x, const Eigen::VectorXd& precision);

/// Minimises sum W_ij (D_ij - S_ij)^2 + tr(P Delta S R (Delta S)') over S, that is solves
///   W o S + Delta'P Delta S R = W o D
/// by preconditioned conjugate gradients from S on, R symmetric positive definite [columns x
/// columns], P the diagonal `precision` as of stiffness(). The preconditioner is the same system
/// with the diagonal of R in its place, one pentadiagonal matrix per column. Stops after
/// `iterations`, or when r'M^-1 r is `tolerance`^2 of what it is for S = 0. Returns the iterations
/// taken.
int smooth(const Matrix& data, const Matrix& weights, const Eigen::VectorXd& precision,
           const Matrix& R, int iterations, double tolerance, Matrix& S);

/// One window cleaned.
struct MatrixNormalSolution {
  Matrix low_rank;   ///< the motion
  Matrix sparse;     ///< D minus the motion where a sample was rejected, else 0
  Matrix trusted;    ///< 1 where a sample was used, else 0
  Matrix deviation;  ///< standard deviation of the motion
  SegmentOutcome outcome;
};

/// The motion of one window [frames x columns], NaN where data is missing. A window of
/// fewer than five frames has its gaps filled linearly, no more. Throws Cancelled soon after `stop`
/// is requested.
MatrixNormalSolution solve(const ConstMatrixRef& data, const MatrixNormal& method,
                           const std::stop_token& stop = {}, const MotionPrior& prior = {});

}  // namespace moclean::reference
