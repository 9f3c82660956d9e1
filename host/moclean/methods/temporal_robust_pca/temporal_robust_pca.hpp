#pragma once

#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

/// Robust PCA of a matrix whose columns are smooth along the rows, with missing entries (NaN):
///   minimise  nu |L|_* + |Lambda o E|_1 + gamma/2 |Delta S|_F^2   subject to  S = L, D = S + E
/// where Delta is the second difference along time and Lambda_ij = lambda, 0 where D is missing: E
/// is free there. By ADMM with two blocks, (S) and (L, E), and a growing penalty mu:
///   (gamma Delta'Delta + 2 mu I) S = mu (D - E) + Y + mu L + U     a band system per column
///   L = SVT_{nu/mu}(S - U/mu)
///   T = D - S + Y/mu,  Y+ = clamp(mu T, -Lambda, Lambda),  E = T - Y+/mu
///   U+ = U + mu (L - S),  mu+ = min(rho mu, mu_max_factor mu_0)
/// from S = L = D with its gaps filled along time, E = Y = U = 0, mu_0 = mu0_factor / |S|_2, until
/// D - S - E where D was observed and L - S are both at most tolerance |D|_F (Frobenius norms, of
/// the observed entries). A = S, which fills the gaps.
///
/// nu has no unit. gamma has that of 1/length; 0 asks for the rule of penalty_of(), which makes the
/// method scale with its data.
struct TemporalRobustPca {
  static constexpr bool accepts_missing = true;

  double gamma = 0;   ///< 0 to 1e10; 0: penalty_of() says
  double nu = 0.3;    ///< weight of |L|_*, > 0
  double lambda = 0;  ///< weight of |E|_1, to 1e10; 0: lambda_scale / sqrt(max(rows, columns))
  double lambda_scale = 1;     ///< > 0, to 1e10; used when lambda is 0
  double rho = 1.1;            ///< growth of mu, > 1
  double mu0_factor = 1.25;    ///< > 0
  double mu_max_factor = 1e7;  ///< >= 1
  double tolerance = 1e-6;     ///< > 0
  int max_iterations = 1000;   ///< >= 1

  bool operator==(const TemporalRobustPca&) const = default;

  static constexpr std::string_view name = "tslra";
  static void visit(auto& self, auto& visitor) {
    visitor("gamma", self.gamma);
    visitor("nu", self.nu);
    visitor("lambda", self.lambda);
    visitor("lambda-scale", self.lambda_scale);
    visitor("rho", self.rho);
    visitor("tolerance", self.tolerance);
    visitor("max-iterations", self.max_iterations);
  }
};

/// Throws ArgumentError naming the first parameter out of its range.
void check(const TemporalRobustPca& method);

/// What a segment's iteration starts from; the same bits on every backend.
struct TemporalStart {
  Matrix data;      ///< D with its gaps filled along time, [rows x columns]
  Matrix observed;  ///< 1 where D was observed, else 0
  double norm = 0;  ///< |D|_F of the observed entries
  double lambda = 0;
  double gamma = 0;
};

TemporalStart start_temporal(const ConstMatrixRef& data, const TemporalRobustPca& method);

/// gamma by the rule  lambda (s + sigma) / s^2, with s the size of the motion's second differences
/// and sigma that of dense noise, each the root mean square over the columns of a robust deviation
/// (the lower quartile of magnitudes, so that up to half of the differences may be spoilt):
///   sigma  from fourth differences, as if all of them were noise;
///   s      from second differences over one frame, limited to 1 to 10 times what those over eight
///          frames say, divided by 64: noise weighs little in these, fast motion too.
/// Only differences of observed samples count. Segments of fewer than 32 rows take s over one frame
/// as it is; a segment without motion counts as moving by 1e-6 of its size.
double penalty_of(const ConstMatrixRef& data, double lambda);

}  // namespace moclean
