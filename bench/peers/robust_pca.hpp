#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "peers/segment_solver.hpp"
#include "peers/sweep.hpp"

namespace moclean::peers {

/// The iteration of methods/robust_pca/reference.cpp with eigenvectors of the Gram matrix in place
/// of the SVD, on packed matrices D, A, X, Y [m x n] with m >= n. A segment with fewer rows than
/// columns is solved transposed: the same problem.
///
/// Algebra is what the peers differ in. Its matrices are packed and row-major, [m x n]:
///   void resize(m, n)         makes room for the following
///   double norm_2(X)          largest singular value
///   int shrink(X, tau, A)     A = U max(sigma - tau, 0) V' for X = U sigma V'; returns rank(A)
template <class Algebra>
class RobustPcaSolver final : public SegmentSolver {
 public:
  explicit RobustPcaSolver(Algebra algebra) : algebra_(std::move(algebra)) {}

  Outcome solve(const Segment& segment, const Parameters& parameters) override {
    load(segment);
    const double norm = frobenius(D_);
    Outcome outcome{.converged = norm == 0};
    if (norm > 0) {
      start(parameters);
      outcome = iterate(parameters, norm);
    }
    store(segment);
    return outcome;
  }

 private:
  using Numbers = std::vector<double>;

  static double frobenius(const Numbers& x) {
    double squares = 0;
    for (const double entry : x) squares += entry * entry;
    return std::sqrt(squares);
  }

  // Y = D / max(|D|_2, max|D_ij| / lambda), mu = mu0_factor / |D|_2, X = D + Y/mu
  void start(const Parameters& parameters) {
    const double norm_2 = algebra_.norm_2(D_.data());
    double largest = 0;
    for (const double entry : D_) largest = std::max(largest, std::abs(entry));
    const double dual_scale = std::max(norm_2, largest / parameters.lambda);
    mu_ = parameters.mu0_factor / norm_2;
    for (std::size_t i = 0; i < D_.size(); ++i) {
      Y_[i] = D_[i] / dual_scale;
      X_[i] = D_[i] + Y_[i] / mu_;
    }
  }

  Outcome iterate(const Parameters& parameters, double norm) {
    const double mu_max = parameters.mu_max_factor * mu_;
    const Entries entries{D_.data(), A_.data(), X_.data(), Y_.data(), D_.size()};
    Outcome outcome;
    for (double mu = mu_; !outcome.converged && outcome.iterations < parameters.max_iterations;
         mu = next_mu_) {
      mu_ = mu;
      next_mu_ = std::min(parameters.rho * mu, mu_max);
      outcome.rank = algebra_.shrink(X_.data(), 1 / mu, A_.data());
      outcome.residual = std::sqrt(sweep(entries, parameters.lambda, mu_, next_mu_)) / norm;
      outcome.converged = outcome.residual <= parameters.tolerance;
      ++outcome.iterations;
    }
    return outcome;
  }

  void load(const Segment& segment) {
    transposed_ = segment.rows < segment.columns;
    m_ = std::max(segment.rows, segment.columns);
    n_ = std::min(segment.rows, segment.columns);
    algebra_.resize(m_, n_);
    for (Numbers* matrix : {&D_, &A_, &X_, &Y_})
      matrix->assign(static_cast<std::size_t>(m_) * static_cast<std::size_t>(n_), 0);
    mu_ = next_mu_ = 1;
    for_each_entry(segment, [&](std::size_t i, std::ptrdiff_t at) { D_[i] = segment.data[at]; });
  }

  // The last sweep left X = A - Y_old/mu + Y (1/mu + 1/mu+), which gives
  //   E = D - A + Y_old/mu - Y/mu = D - X + Y/mu+
  void store(const Segment& segment) const {
    for_each_entry(segment, [&](std::size_t i, std::ptrdiff_t at) {
      segment.low_rank[at] = A_[i];
      segment.sparse[at] = D_[i] - X_[i] + Y_[i] / next_mu_;
    });
  }

  // visit(index in the packed matrix, offset in the segment)
  template <class Visit>
  void for_each_entry(const Segment& segment, const Visit& visit) const {
    const std::ptrdiff_t row_step = transposed_ ? 1 : segment.pitch;
    const std::ptrdiff_t column_step = transposed_ ? segment.pitch : 1;
    std::size_t i = 0;
    for (int row = 0; row < m_; ++row)
      for (int column = 0; column < n_; ++column) visit(i++, row * row_step + column * column_step);
  }

  Algebra algebra_;
  Numbers D_, A_, X_, Y_;
  int m_ = 0, n_ = 0;
  bool transposed_ = false;
  double mu_ = 1, next_mu_ = 1;  // of the last iteration
};

}  // namespace moclean::peers
