#pragma once

#include <Eigen/Core>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// What MatrixNormal has found of one window. Matrices are [frames x columns], at least three
/// frames; a joint is a run of `joint_columns` neighbouring columns, the last may be shorter.
struct MotionEstimate {
  Matrix motion;              ///< S
  Mask used;                  ///< samples that S was fitted to
  Matrix rejected;            ///< D - S of observed samples that S was not fitted to, else 0
  Matrix prior_variance;      ///< of what else is known of missing samples; infinite: nothing
  Matrix confidence = {};     ///< c: samples have noise of variance sigma^2 / c; empty: 1
  Matrix eigenvectors;        ///< of Q, in rows [columns x columns]
  Eigen::VectorXd spectrum;   ///< eigenvalues of Q, its ridge included, above 0
  Eigen::VectorXd precision;  ///< of the accelerations, over Q's [frames - 2]
  double noise = 0;           ///< sigma of the samples
  double size = 0;            ///< of a body: typical distances, above 0
  double floor = 0;           ///< sigma that is none: samples in use come out as they are; above 0
  Index joint_columns = 3;
  bool has_prior = false;  ///< Q has a prior, see MatrixNormalWindow::add_prior()
};

/// Marginal standard deviation of every entry of S, [frames x columns]; docs/decisions/sigma.md.
///   Samples in use: the posterior variance under white noise, in the eigenbasis of Q; the floor
/// where there is no noise.
///   Others add what their gap leaves open. The innovation of a joint, its acceleration less what
/// the other joints' accelerations predict, tells the error that a gap anywhere would have had,
/// were all others known: gaps of 1 to 127 frames are tried all over the window, and give every
/// column the growth of its error with the length of a gap. Columns missing together have a larger
/// variance of innovation, that of Q given the columns in use in that frame. What is known of
/// missing samples otherwise is joined by precision.
Matrix marginal_deviation(const MotionEstimate& estimate);

/// Diagonals of (diag(c) + ratio Delta' P Delta)^-1 for every ratio of the variance of white noise
/// to that of accelerations, [frames x ratios]: the share of the noise that smoothing leaves. P is
/// the diagonal `precision` [frames - 2], c the confidence of the samples [frames].
Matrix variance_left(const Eigen::VectorXd& ratios, const Eigen::VectorXd& precision,
                     const Eigen::VectorXd& confidence);

/// Variance of each column's acceleration given those in use, [columns], for columns not in use;
/// else 0. `Q` is the covariance of accelerations, `R` its inverse.
Eigen::VectorXd conditional_variance(const Matrix& Q, const Matrix& R,
                                     const Eigen::Array<bool, Eigen::Dynamic, 1>& used);

}  // namespace moclean
