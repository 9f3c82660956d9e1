// Notation, one segment of m frames and n columns, all matrices [m x n]:
//   D, P        data with its gaps filled, and 1 where it was observed, else 0
//   S, L, E     smooth, low-rank and sparse part: S = L, D = S + E in the end
//   Y, U        Lagrange multipliers of D = S + E and of S = L
//   Delta       second difference along time
//   the rest as in methods/temporal_robust_pca/temporal_robust_pca.hpp
#include "moclean/methods/temporal_robust_pca/reference.hpp"

#include <algorithm>

#include "moclean/core/band_matrix.hpp"
#include "moclean/core/error.hpp"
#include "moclean/solve/reference_svd.hpp"

namespace moclean::reference {
namespace {

using Eigen::MatrixXd;

struct State {
  MatrixXd D, P, S, L, E, Y, U;
  double lambda = 0, gamma = 0, nu = 0;
  double mu = 0;
  int rank = 0;  // singular values that survived the last threshold
};

// S = L = D, E = Y = U = 0, mu = mu0_factor / |D|_2.
void start(State& s, const TemporalStart& from, const TemporalRobustPca& method) {
  s.D = s.S = s.L = from.data;
  s.P = from.observed;
  s.E = s.Y = s.U = MatrixXd::Zero(s.D.rows(), s.D.cols());
  s.lambda = from.lambda;
  s.gamma = from.gamma;
  s.nu = method.nu;
  s.mu = method.mu0_factor / thin_svd(s.D).sigma(0);
}

// (gamma Delta'Delta + 2 mu I) S = mu (D - E) + Y + mu L + U
void update_smooth(State& s) {
  const auto rows = static_cast<std::size_t>(s.D.rows());
  BandMatrix a = difference_penalty(rows, 2, s.gamma);
  for (auto& row : a.rows) row[0] += 2 * s.mu;
  factor(a);
  s.S = s.mu * (s.D - s.E) + s.Y + s.mu * s.L + s.U;
  for (Index j = 0; j < s.S.cols(); ++j) moclean::solve(a, {s.S.col(j).data(), rows});
}

// L = SVT_{nu/mu}(S - U/mu)
void update_low_rank(State& s) {
  const double tau = s.nu / s.mu;
  const Svd svd = thin_svd(s.S - s.U / s.mu);
  const auto r = (svd.sigma.array() > tau).count();
  const Eigen::VectorXd kept = svd.sigma.head(r).array() - tau;
  s.L = svd.u.leftCols(r) * kept.asDiagonal() * svd.v.leftCols(r).transpose();
  s.rank = static_cast<int>(r);
}

// T = D - S + Y/mu, Y+ = clamp(mu T, -Lambda, Lambda), E = T - Y+/mu
void update_sparse(State& s) {
  const MatrixXd T = s.D - s.S + s.Y / s.mu;
  const Eigen::ArrayXXd Lambda = s.lambda * s.P.array();
  s.Y = (s.mu * T).array().max(-Lambda).min(Lambda);
  s.E = T - s.Y / s.mu;
}

}  // namespace

TemporalSolution solve(const ConstMatrixRef& data, const TemporalRobustPca& method,
                       const std::stop_token& stop) {
  const TemporalStart from = start_temporal(data, method);
  const Matrix zero = Matrix::Zero(data.rows(), data.cols());
  if (from.norm == 0)
    return {zero, zero, zero, {.iterations = 0, .rank = 0, .residual = 0, .converged = true}};

  State s;
  start(s, from, method);
  const double mu_max = method.mu_max_factor * s.mu;
  SegmentOutcome outcome;
  while (!outcome.converged && outcome.iterations < method.max_iterations) {
    if (stop.stop_requested()) throw Cancelled();
    update_smooth(s);
    update_low_rank(s);
    update_sparse(s);
    s.U += s.mu * (s.L - s.S);                   // U = U + mu (L - S)
    s.mu = std::min(method.rho * s.mu, mu_max);  // mu = min(rho mu, mu_max)
    const double gap = s.P.cwiseProduct(s.D - s.S - s.E).norm(), split = (s.L - s.S).norm();
    ++outcome.iterations;
    outcome.rank = s.rank;
    outcome.residual = std::max(gap, split) / from.norm;
    outcome.converged = outcome.residual <= method.tolerance;
  }
  return {s.S, s.P.cwiseProduct(s.E), s.Y, outcome};
}

}  // namespace moclean::reference
