#pragma once

#include <cmath>

#include <Eigen/QR>

#include "moclean/core/random.hpp"

#include "support/matrix.hpp"

namespace moclean::test {

/// Motion drawn from the model of MatrixNormal: accelerations with a covariance over all columns.
struct ModelMotion {
  Matrix motion;             ///< [frames x columns]
  Matrix eigenvectors;       ///< of the covariance, in rows
  Eigen::VectorXd spectrum;  ///< its eigenvalues, from 1 down by e every three columns
};

inline ModelMotion model_motion(Index frames, Index columns, std::uint64_t seed) {
  const Eigen::MatrixXd square = random_matrix(columns, columns, seed);
  ModelMotion model{Matrix::Zero(frames, columns),
                    Eigen::HouseholderQR<Eigen::MatrixXd>(square).householderQ() *
                        Eigen::MatrixXd::Identity(columns, columns),
                    Eigen::VectorXd(columns)};
  for (Index k = 0; k < columns; ++k) model.spectrum(k) = std::exp(-static_cast<double>(k) / 3);
  const Matrix a = random_matrix(frames, columns, seed + 1) *
                   model.spectrum.cwiseSqrt().asDiagonal() * model.eigenvectors;
  for (Index i = 2; i < frames; ++i)
    model.motion.row(i) = 2 * model.motion.row(i - 1) - model.motion.row(i - 2) + a.row(i);
  return model;
}

}  // namespace moclean::test
