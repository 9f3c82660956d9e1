#pragma once

#include <Eigen/Core>

#include "support/matrix.hpp"

namespace moclean::test {

// Eigen's decompositions, which judge ours. Compiled once, optimised: they take long to compile,
// and crawl in the tests themselves, which are not.

/// By one-sided Jacobi rotations; decreasing.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& x);

/// Of a symmetric matrix; increasing.
Eigen::VectorXd eigenvalues(const Matrix& symmetric);

/// Q of the QR decomposition of a square matrix.
Matrix orthogonal_factor(const Matrix& square);

}  // namespace moclean::test
