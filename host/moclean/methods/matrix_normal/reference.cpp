// Notation: D data, S motion, W weights over variances, P precisions, R about Q^-1, r residual, z =
// M^-1 r preconditioned residual, p direction; see methods/matrix_normal/matrix_normal.hpp and
// matrix_normal_steps.hpp.
#include "moclean/methods/matrix_normal/reference.hpp"

#include <Eigen/Eigenvalues>

#include "moclean/core/error.hpp"
#include "moclean/methods/matrix_normal/window.hpp"

namespace moclean::reference {
namespace {

/// M = L diag(pivot) L' with a unit L of two lower bands; per column diag(W_j) + R_jj Delta'P
/// Delta.
class Preconditioner {
 public:
  Preconditioner(const Matrix& weights, const Eigen::VectorXd& precision,
                 const Eigen::RowVectorXd& stiffness)
      : inverse_pivot_(weights.rows(), weights.cols()),
        first_(Matrix::Zero(weights.rows(), weights.cols())),
        second_(first_) {
    const Index rows = weights.rows();
    const double least = least_preconditioner_weight * stiffness.mean();
    for (Index i = 0; i < rows; ++i) {
      const auto p = [&](Index k) { return k >= 0 ? precision(k) : 0.; };
      const double diagonal = p(i) + 4 * p(i - 1) + p(i - 2);
      const double next = -2 * (p(i - 1) + p(i - 2));
      Eigen::RowVectorXd pivot = weights.row(i) + diagonal * stiffness;
      pivot.array() += least;
      if (i >= 2) second_.row(i) = p(i - 2) * stiffness.cwiseProduct(inverse_pivot_.row(i - 2));
      if (i >= 1) {
        Eigen::RowVectorXd l = next * stiffness;
        if (i >= 2) l -= p(i - 2) * stiffness.cwiseProduct(first_.row(i - 1));
        first_.row(i) = l.cwiseProduct(inverse_pivot_.row(i - 1));
        pivot -= l.cwiseProduct(first_.row(i));
      }
      if (i >= 2) pivot -= p(i - 2) * stiffness.cwiseProduct(second_.row(i));
      inverse_pivot_.row(i) = pivot.cwiseInverse();
    }
  }

  Matrix solve(Matrix x) const {
    const Index rows = x.rows();
    for (Index i = 1; i < rows; ++i) {
      x.row(i) -= first_.row(i).cwiseProduct(x.row(i - 1));
      if (i >= 2) x.row(i) -= second_.row(i).cwiseProduct(x.row(i - 2));
    }
    x = x.cwiseProduct(inverse_pivot_);
    for (Index i = rows - 2; i >= 0; --i) {
      x.row(i) -= first_.row(i + 1).cwiseProduct(x.row(i + 1));
      if (i + 2 < rows) x.row(i) -= second_.row(i + 2).cwiseProduct(x.row(i + 2));
    }
    return x;
  }

 private:
  Matrix inverse_pivot_, first_, second_;
};

struct Spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  // in columns

  Matrix weighted(const Eigen::VectorXd& f) const {  // Z' diag(f) Z
    return vectors * f.asDiagonal() * vectors.transpose();
  }
};

Spectrum spectrum_of(const Matrix& square) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(square);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

}  // namespace

Matrix stiffness(const Matrix& x, const Eigen::VectorXd& precision) {
  Matrix result = Matrix::Zero(x.rows(), x.cols());
  const Index count = x.rows() - 2;
  if (count < 1) return result;
  const Matrix a = precision.head(count).asDiagonal() *
                   (x.topRows(count) - 2 * x.middleRows(1, count) + x.bottomRows(count));
  result.topRows(count) += a;
  result.middleRows(1, count) -= 2 * a;
  result.bottomRows(count) += a;
  return result;
}

int smooth(const Matrix& data, const Matrix& weights, const Eigen::VectorXd& precision,
           const Matrix& R, int iterations, double tolerance, Matrix& S) {
  const Preconditioner M(weights, precision, R.diagonal().transpose());
  const auto product = [&](const Matrix& x) -> Matrix {
    return weights.cwiseProduct(x) + stiffness(x, precision) * R;
  };
  const Matrix b = weights.cwiseProduct(data);
  const double enough = tolerance * tolerance * b.cwiseProduct(M.solve(b)).sum();
  Matrix r = b - product(S);
  Matrix z = M.solve(r), p = z;
  double rz = r.cwiseProduct(z).sum();
  int taken = 0;
  while (taken < iterations && rz > enough) {
    const Matrix q = product(p);
    const double alpha = rz / p.cwiseProduct(q).sum();
    S += alpha * p;
    r -= alpha * q;
    z = M.solve(r);
    const double before = rz;
    rz = r.cwiseProduct(z).sum();
    p = z + rz / before * p;
    ++taken;
  }
  return taken;
}

MatrixNormalSolution solve(const ConstMatrixRef& data, const MatrixNormal& method,
                           const std::stop_token& stop, const MotionPrior& prior) {
  MatrixNormalWindow window(data, method, prior);
  MatrixNormalSolution solution;
  solution.outcome = {
      .iterations = 0, .rank = {}, .residual = 0, .converged = false, .fixed_steps = true};
  Matrix S = Matrix::Zero(window.rows(), window.columns());
  Spectrum Q;
  if (!window.trivial()) {
    const Matrix ones = Matrix::Ones(window.rows(), window.columns());
    const auto guess = window.first_guess();
    S = guess.motion;
    smooth(guess.motion, ones, window.precision(), guess.stiffness.asDiagonal().toDenseMatrix(),
           method.solve_iterations, method.tolerance(0), S);
    for (int step = 0; step < window.steps(); ++step) {
      if (stop.stop_requested()) throw Cancelled();
      Matrix A = window.accelerations(S);
      if (const auto growth = window.growth()) A *= Q.weighted(*growth);
      Matrix square = A.transpose() * A;
      window.add_prior(square);
      Q = spectrum_of(square);
      const Matrix R = Q.weighted(window.inverse_spectrum(Q.values));
      window.weigh(S, R);
      solution.outcome.iterations += smooth(window.target(), window.weights(), window.precision(),
                                            R, method.solve_iterations, method.tolerance(step), S);
      window.estimate_noise(S);
    }
  }
  solution.low_rank = window.trivial() ? window.filled() : window.cleaned(S);
  solution.sparse = window.rejected(solution.low_rank);
  solution.trusted = window.trusted().cast<double>();
  solution.deviation = window.deviation(S, Q.vectors.transpose());
  return solution;
}

}  // namespace moclean::reference
