// The Eigen peer. A packed row-major X [m x n] is seen as the column-major X' [n x m], hence
//   G = X'X = (X')(X')'    A' = W X'    W = V diag(f) V'    f_k = 1 - tau/sigma_k for sigma_k > tau
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "peers/robust_pca.hpp"

namespace moclean::peers {
namespace {

using Eigen::MatrixXd;
using View = Eigen::Map<const MatrixXd>;

class EigenAlgebra {
 public:
  void resize(int m, int n) {
    m_ = m;
    n_ = n;
  }

  double norm_2(const double* X) {
    gram(View(X, n_, m_));
    solver_.compute(G_, Eigen::EigenvaluesOnly);
    return std::sqrt(solver_.eigenvalues()(n_ - 1));
  }

  int shrink(const double* x, double tau, double* a) {
    const View X(x, n_, m_);
    Eigen::Map<MatrixXd> A(a, n_, m_);
    gram(X);
    solver_.compute(G_);
    const auto& squares = solver_.eigenvalues();
    const Eigen::Index rank = (squares.array() > tau * tau).count();
    const auto V = solver_.eigenvectors().rightCols(rank);
    const Eigen::ArrayXd f = 1 - tau / squares.tail(rank).array().sqrt();
    scaled_ = V * f.matrix().asDiagonal();
    if (2 * rank < n_) {  // fewer operations than with W
      projected_.noalias() = V.transpose() * X;
      A.noalias() = scaled_ * projected_;
    } else {
      W_.noalias() = scaled_ * V.transpose();
      A.noalias() = W_ * X;
    }
    return static_cast<int>(rank);
  }

 private:
  void gram(const View& X) {
    G_.setZero(n_, n_);
    G_.selfadjointView<Eigen::Lower>().rankUpdate(X);
  }

  Eigen::Index m_ = 0, n_ = 0;
  MatrixXd G_, W_, scaled_, projected_;
  Eigen::SelfAdjointEigenSolver<MatrixXd> solver_;
};

class EigenEigensolver final : public Eigensolver {
 public:
  void solve(int n, double* matrix, double* values) override {
    solver_.compute(View(matrix, n, n));
    Eigen::Map<MatrixXd>(matrix, n, n) = solver_.eigenvectors();
    Eigen::Map<Eigen::VectorXd>(values, n) = solver_.eigenvalues();
  }

 private:
  Eigen::SelfAdjointEigenSolver<MatrixXd> solver_;
};

}  // namespace

std::unique_ptr<SegmentSolver> make_eigen_solver() {
  return std::make_unique<RobustPcaSolver<EigenAlgebra>>(EigenAlgebra());
}

std::unique_ptr<Eigensolver> make_eigen_eigensolver() {
  return std::make_unique<EigenEigensolver>();
}

}  // namespace moclean::peers
