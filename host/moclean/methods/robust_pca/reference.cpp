// Notation, one segment of m frames and n columns, all matrices [m x n]:
//   D            data
//   A, E         low-rank and sparse part, D = A + E in the end
//   Y            Lagrange multipliers of D = A + E
//   mu           penalty of the augmented Lagrangian, grows by rho
//   lambda       weight of |E|_1
//   P            1 where D was observed, else 0; a missing entry has weight 0 in |E|_1: Y is 0
//                there, E is free
//   |D|_2, |D|_F largest singular value, root of the sum of squares
//   SVT_tau(X)   U max(sigma - tau, 0) V' for X = U sigma V': singular value thresholding
//   soft(T, tau) x - tau for x > tau, x + tau for x < -tau, else 0, for every entry x of T
#include "moclean/methods/robust_pca/reference.hpp"

#include <algorithm>

#include "moclean/core/error.hpp"
#include "moclean/solve/missing.hpp"
#include "moclean/solve/reference_svd.hpp"

namespace moclean::reference {
namespace {

using Eigen::MatrixXd;

struct State {
  MatrixXd D, P, A, E, Y;
  double lambda = 0;
  double mu = 0;
  int rank = 0;  // singular values that survived the last threshold
};

// Y = D / max(|D|_2, max|D_ij| / lambda), mu = mu0_factor / |D|_2, A = E = 0. Of D with its gaps
// filled along time, except for the largest entry; where D is missing Y = 0 and A is what fills it.
void start(State& s, const ConstMatrixRef& data, const RobustPca& method) {
  s.P = observed_entries(data);
  s.D = filled_along_time(data);
  s.E = MatrixXd::Zero(s.D.rows(), s.D.cols());
  s.A = s.D - s.P.cwiseProduct(s.D);
  s.lambda = lambda_of(method, s.D.rows(), s.D.cols());
  const double norm_2 = thin_svd(s.D).sigma(0);
  const double largest = s.P.cwiseProduct(s.D).cwiseAbs().maxCoeff();
  s.Y = s.P.cwiseProduct(s.D) / std::max(norm_2, largest / s.lambda);
  s.mu = method.mu0_factor / norm_2;
}

// A = SVT_{1/mu}(D - E + Y/mu)
void update_low_rank(State& s) {
  const double tau = 1 / s.mu;
  const Svd svd = thin_svd(s.D - s.E + s.Y / s.mu);
  const auto r = (svd.sigma.array() > tau).count();
  const Eigen::VectorXd kept = svd.sigma.head(r).array() - tau;
  s.A = svd.u.leftCols(r) * kept.asDiagonal() * svd.v.leftCols(r).transpose();
  s.rank = static_cast<int>(r);
}

// E = soft(D - A + Y/mu, P lambda/mu)
void update_sparse(State& s) {
  const Eigen::ArrayXXd tau = s.P.array() * (s.lambda / s.mu);
  const MatrixXd T = s.D - s.A + s.Y / s.mu;
  s.E = (T.array() - tau).max(0) + (T.array() + tau).min(0);
}

}  // namespace

RobustPcaSolution solve(const ConstMatrixRef& data, const RobustPca& method,
                        const std::stop_token& stop) {
  const double norm = observed_part(data).norm();
  if (norm == 0) {
    const Matrix zero = Matrix::Zero(data.rows(), data.cols());
    return {zero, zero, zero, {.iterations = 0, .rank = 0, .residual = 0, .converged = true}};
  }

  State s;
  start(s, data, method);
  const double mu_max = method.mu_max_factor * s.mu;
  SegmentOutcome outcome;
  while (!outcome.converged && outcome.iterations < method.max_iterations) {
    if (stop.stop_requested()) throw Cancelled();
    if (method.order == UpdateOrder::ae) {
      update_low_rank(s);
      update_sparse(s);
    } else {
      update_sparse(s);
      update_low_rank(s);
    }
    const MatrixXd R = s.P.cwiseProduct(s.D - s.A - s.E);
    s.Y += s.mu * R;                             // Y = Y + mu (D - A - E)
    s.mu = std::min(method.rho * s.mu, mu_max);  // mu = min(rho mu, mu_max)
    ++outcome.iterations;
    outcome.rank = s.rank;
    outcome.residual = R.norm() / norm;  // |D - A - E|_F / |D|_F
    outcome.converged = outcome.residual <= method.tolerance;
  }
  return {s.A, s.P.cwiseProduct(s.E), s.Y, outcome};
}

}  // namespace moclean::reference
