#include "support/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace moclean::test {

Eigen::VectorXd singular_values(const Eigen::MatrixXd& x) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(x).singularValues();
}

Eigen::VectorXd eigenvalues(const Matrix& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(symmetric).eigenvalues();
}

Matrix orthogonal_factor(const Matrix& square) {
  return Eigen::HouseholderQR<Matrix>(square).householderQ();
}

}  // namespace moclean::test
