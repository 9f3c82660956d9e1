#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "moclean/core/band_matrix.hpp"
#include "moclean/core/matrix.hpp"
#include "moclean/methods/matrix_normal/matrix_normal.hpp"
#include "moclean/solve/motion_prior.hpp"

namespace moclean::reference {

// The statistics of MatrixNormal by their definitions, in the plainest form. What the device form
// has of them (methods/matrix_normal/window.hpp) is another text: --verify compares the two.

inline double squared(double x) { return x * x; }

/// What is known of a window between two steps. Matrices are [frames x columns].
struct SmoothingState {
  const MatrixNormal* method = nullptr;
  const MotionPrior* prior = nullptr;
  Matrix data;             ///< D; where missing samples should be, as far as known, else 0
  Mask observed;           ///< samples that were not NaN
  Mask confirmed;          ///< samples that are right
  Matrix confidence;       ///< c: the noise of a sample has the variance sigma^2 / c
  Matrix prior_variance;   ///< of what is known of missing samples; infinite: nothing
  Matrix prior_share;      ///< of the precision with which that counts
  Matrix nearness;         ///< of columns, [columns x columns]; empty where they are no joints
  double size = 0;         ///< of a body
  double floor = 0;        ///< sigma that is none
  double least_noise = 0;  ///< least sigma, for what neighbouring frames share
  double sigma = 0;
  int step = 0;
  Matrix weights;              ///< W
  Eigen::VectorXd precision;   ///< P [frames - 2]
  Eigen::VectorXd spectrum;    ///< e of Q, its ridge included
  Eigen::VectorXd predictive;  ///< variance of an acceleration given the others', 1 / R_jj

  Index frames() const { return data.rows(); }
  Index columns() const { return data.cols(); }
  bool hard() const { return step >= method->soft_steps; }
  double share_kept() const { return std::max(weights.cwiseProduct(confidence).mean(), 1e-3); }
  double variance(Index i, Index j) const { return sigma * sigma / confidence(i, j); }
};

/// `data` is [frames x columns], NaN where missing. `method` and `prior` outlive the state.
SmoothingState begin(const ConstMatrixRef& data, const MatrixNormal& method,
                     const MotionPrior& prior);

/// D, gaps of which nothing is known filled linearly.
Matrix filled(const SmoothingState& state);

/// Running medians of the filled data, and of each column the ratio of the variance of noise to
/// that of accelerations, between 1 and 1000: lags of h frames have the variance
/// 6 sigma^2 + h^4 q.
struct RoughMotion {
  Matrix motion;
  Eigen::VectorXd stiffness;  ///< [columns]
};
RoughMotion rough_motion(const SmoothingState& state);

/// x_i - 2 x_i+1 + x_i+2 of every row i, [frames - 2 x columns].
Matrix second_differences(const ConstMatrixRef& x);

/// diag(weights) + stiffness Delta' diag(precision) Delta, one row per weight, Delta the second
/// differences; precision has two entries less, or more of which the last are not read.
BandMatrix smoothing_system(const Eigen::VectorXd& weights, const Eigen::VectorXd& precision,
                            double stiffness);

/// Share of the acceleration power that smoothing keeps: the mean over frequencies w of
/// 1 / (1 + noise / power (2 - 2 cos w)^2), which is Re (1 + 4 i sqrt(noise / power))^-1/2.
double kept_share(double noise, double power);

/// kept_share() of every eigenvector of the Q of the step before; nothing where noise does not
/// matter.
std::optional<Eigen::VectorXd> kept_shares(const SmoothingState& state);

/// Second differences of S, clipped in soft steps, in hard ones weighted by their precisions,
/// [frames - 2 x columns].
Matrix learned_accelerations(const SmoothingState& state, const ConstMatrixRef& S);

/// Q, the sum over the frames of the products of the accelerations, with the prior sqrt(Q_ii Q_jj)
/// times the nearness of i and j.
Matrix with_nearness_prior(const SmoothingState& state, const Matrix& Q);

/// e, given the eigenvalues of that: over the number of accelerations, with a ridge.
Eigen::VectorXd ridged(const SmoothingState& state, const Eigen::VectorXd& eigenvalues);

/// W, P and the variances 1 / R_jj to the state. Returns the terms of the fit of S.
struct Terms {
  Matrix weights;  ///< W / v
  Matrix target;   ///< D, or where missing samples should be
};
Terms weigh(SmoothingState& state, const ConstMatrixRef& S, const Matrix& R);

/// sigma from D - S; ends the step.
void estimate_noise(SmoothingState& state, const ConstMatrixRef& S);

/// What comes out: S, but D where it was used if there is no noise.
Matrix cleaned(const SmoothingState& state, const ConstMatrixRef& S);

/// D - x where a sample was observed and is not used, else 0.
Matrix rejected(const SmoothingState& state, const ConstMatrixRef& x);

/// NaN in columns without a sample.
void leave_unobserved(const SmoothingState& state, Matrix& x);

/// Harmonic mean of the frames from each sample to the nearest ones in use before and after it.
/// The window's ends count as samples in use that are `beyond_end` frames beyond its outermost.
Matrix harmonic_distance(const Mask& used, double beyond_end);

/// `positions` [frames x 3 joints] with the free joints [frames x joints] moved along the exact
/// links until these have their lengths: five sweeps over the links, one after the other, in which
/// the free ends of a link share what it is too long.
Matrix fitted_to_lengths(const std::vector<DistanceLink>& links, const Mask& free,
                         Matrix positions);

}  // namespace moclean::reference
