#pragma once

#include <Eigen/Core>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// Precisions of the accelerations S'' = Delta S of motion in time, over those of Q: row k, of the
/// frames k to k + 2, is normal with covariance Q / precision_k, whose tails are heavy as impacts
/// and kicks need them. Gives the precisions [frames - 2] anew from
///   motion      S, [frames x columns], at least three frames
///   R           Q^-1, with `spectrum` the eigenvalues of Q
///   noise       variance of the samples
///   used        samples that S was fitted to, [frames x columns]
///   before      the precisions that S was fitted with
/// by evidence (MacKay 1992): precision_k = (f + g) / (f + S''_k R S''_k'), where g, at most the
/// number of columns, is how many numbers of S''_k the samples tell under noise, and f how many the
/// scale of all frames counts for: few, but the more the more samples of those frames are not used,
/// so that a gross error or a gap hardly tells of a scale.
Eigen::VectorXd acceleration_precision(const ConstMatrixRef& motion, const ConstMatrixRef& R,
                                       const Eigen::VectorXd& spectrum, double noise,
                                       const Mask& used, const Eigen::VectorXd& before);

/// Weights of the accelerations in A'A, for Q: half way, as a power, from those of the most likely
/// Q, the roots of the precisions, to 1. Their squares have the mean 1. As many as precisions.
Eigen::VectorXd acceleration_weights(const Eigen::VectorXd& precision);

}  // namespace moclean
