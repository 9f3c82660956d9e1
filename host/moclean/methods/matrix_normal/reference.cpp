// Notation: D data, S motion, W weights over variances, P precisions, R about Q^-1, r residual, z =
// M^-1 r preconditioned residual, p direction; see methods/matrix_normal/matrix_normal.hpp.
#include "moclean/methods/matrix_normal/reference.hpp"

#include <Eigen/Eigenvalues>

#include "moclean/core/error.hpp"
#include "moclean/methods/matrix_normal/reference_model.hpp"
#include "moclean/methods/matrix_normal/reference_sigma.hpp"

namespace moclean::reference {
namespace {

Eigen::VectorXd solved(const BandMatrix& factor, Eigen::VectorXd b) {
  moclean::solve(factor, {b.data(), static_cast<std::size_t>(b.size())});
  return b;
}

/// M, per column diag(W_j) + R_jj Delta'P Delta and a little, so that it is definite in columns
/// without samples.
class Preconditioner {
 public:
  Preconditioner(const Matrix& weights, const Eigen::VectorXd& precision,
                 const Eigen::VectorXd& stiffness) {
    const double least = 1e-9 * stiffness.mean();
    for (Index j = 0; j < weights.cols(); ++j) {
      columns_.push_back(smoothing_system(weights.col(j).array() + least, precision, stiffness(j)));
      factor(columns_.back());
    }
  }

  Matrix solve(const Matrix& b) const {
    Matrix result(b.rows(), b.cols());
    for (Index j = 0; j < b.cols(); ++j)
      result.col(j) = solved(columns_[static_cast<std::size_t>(j)], b.col(j));
    return result;
  }

 private:
  std::vector<BandMatrix> columns_;  // factors
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

// Frames without samples are appended to a window shorter than it is wide until rows = columns.
Matrix extended(const Matrix& x, Index rows) {
  Matrix result = Matrix::Zero(rows, x.cols());
  result.topRows(x.rows()) = x;
  return result;
}

// 1 of the accelerations that this adds; 0 of the last two rows, which are none.
Eigen::VectorXd extended(const Eigen::VectorXd& precision, Index rows) {
  Eigen::VectorXd result = Eigen::VectorXd::Ones(rows);
  result.head(precision.size()) = precision;
  result.tail(2).setZero();
  return result;
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
  const Preconditioner M(weights, precision, R.diagonal());
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

namespace {

// The rough motion smoothed, each column for its own noise; where frames are appended it goes on as
// it ends.
Matrix first_motion(const SmoothingState& state, Index rows) {
  const RoughMotion rough = rough_motion(state);
  Matrix D = rough.motion.bottomRows(1).replicate(rows, 1);
  D.topRows(state.frames()) = rough.motion;
  Matrix S = D;
  smooth(D, Matrix::Ones(rows, D.cols()), extended(state.precision, rows),
         rough.stiffness.asDiagonal().toDenseMatrix(), state.method->solve_iterations,
         state.method->tolerance(0), S);
  return S;
}

}  // namespace

MatrixNormalSolution solve(const ConstMatrixRef& data, const MatrixNormal& method,
                           const std::stop_token& stop, const MotionPrior& prior) {
  SmoothingState state = begin(data, method, prior);
  MatrixNormalSolution solution;
  solution.outcome = {
      .iterations = 0, .rank = {}, .residual = 0, .converged = false, .fixed_steps = true};
  Matrix S = filled(state);
  Spectrum Q;
  const bool learns = data.rows() >= 5 && state.observed.any();
  if (learns) {
    const Index rows = std::max(data.rows(), data.cols());
    S = first_motion(state, rows);
    for (int step = 0; step < method.soft_steps + method.hard_steps; ++step) {
      if (stop.stop_requested()) throw Cancelled();
      Matrix A = learned_accelerations(state, S);
      if (const auto kept = kept_shares(state)) A *= Q.weighted(kept->cwiseSqrt().cwiseInverse());
      Q = spectrum_of(with_nearness_prior(state, A.transpose() * A));
      state.spectrum = ridged(state, Q.values);
      const Matrix R = Q.weighted(state.spectrum.cwiseInverse());
      const Terms terms = weigh(state, S, R);
      solution.outcome.iterations += smooth(
          extended(terms.target, rows), extended(terms.weights, rows),
          extended(state.precision, rows), R, method.solve_iterations, method.tolerance(step), S);
      estimate_noise(state, S);
    }
  }
  solution.low_rank = cleaned(state, S);
  solution.sparse = rejected(state, solution.low_rank);
  solution.trusted = (state.weights.array() > 0).cast<double>();
  solution.deviation = deviation(state, S, Q.vectors.transpose());
  return solution;
}

}  // namespace moclean::reference
