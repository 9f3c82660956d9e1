#pragma once

#include <array>
#include <string>
#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

/// Which of the two blocks an iteration updates first.
enum class UpdateOrder {
  ae,  ///< A, E, Y, mu: Table 1 of Peng et al.
  ea   ///< E, A, Y, mu: the MATLAB code of Lin, Chen, Ma
};

/// Robust PCA by inexact augmented Lagrange multipliers (Lin, Chen, Ma 2010, algorithm 5):
///   minimise |A|_* + lambda |E|_1  subject to  D = A + E.
/// Start: Y = D / max(|D|_2, max|D_ij| / lambda), E = 0, mu = mu0_factor / |D|_2. Each iteration
/// ends with mu = min(rho mu, mu_max_factor mu_0) and the test |D - A - E|_F <= tolerance |D|_F. A
/// comparison of two solvers has to fix every one of these: the answer depends on them.
struct RobustPca {
  static constexpr bool accepts_missing = true;

  double lambda = 0;  ///< weight of |E|_1, > 0; 0 means lambda_scale / sqrt(max(rows, columns))
  double lambda_scale = 1;     ///< > 0; used when lambda is 0
  double rho = 1.5;            ///< growth of mu, > 1
  double mu0_factor = 1.25;    ///< mu_0 = mu0_factor / |D|_2, > 0
  double mu_max_factor = 1e7;  ///< mu never exceeds mu_max_factor mu_0, >= 1
  double tolerance = 1e-7;     ///< on |D - A - E|_F / |D|_F, > 0
  int max_iterations = 1000;   ///< >= 1
  UpdateOrder order = UpdateOrder::ae;

  bool operator==(const RobustPca&) const = default;

  static constexpr std::array<std::string_view, 2> orders = {"ae", "ea"};
  static void visit(auto& self, auto& visitor) {
    visitor("lambda", self.lambda);
    visitor("lambda-scale", self.lambda_scale);
    visitor("rho", self.rho);
    visitor("tolerance", self.tolerance);
    visitor("max-iterations", self.max_iterations);
    visitor("order", self.order, orders);
  }
};

/// Throws ArgumentError naming the first parameter out of its range.
void check(const RobustPca& method);

/// The lambda used for one segment of the given size.
double lambda_of(const RobustPca& method, Index rows, Index columns);

std::string to_string(UpdateOrder order);

/// Reads `ae` or `ea`; throws ArgumentError for anything else.
UpdateOrder parse_update_order(const std::string& text);

}  // namespace moclean
