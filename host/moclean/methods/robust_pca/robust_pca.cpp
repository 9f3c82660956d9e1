#include "moclean/methods/robust_pca/robust_pca.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

void require(bool valid, const char* name, double value, const char* expected) {
  if (!valid || !std::isfinite(value))
    throw ArgumentError(fmt::format("{} is {}, expected {}", name, value, expected));
}

}  // namespace

void check(const RobustPca& method) {
  require(method.lambda >= 0, "lambda", method.lambda, "a positive number, or 0 for automatic");
  require(method.lambda_scale > 0, "lambda-scale", method.lambda_scale, "a positive number");
  require(method.rho > 1, "rho", method.rho, "a number above 1");
  require(method.mu0_factor > 0, "mu0-factor", method.mu0_factor, "a positive number");
  require(method.mu_max_factor >= 1, "mu-max-factor", method.mu_max_factor,
          "a number of at least 1");
  require(method.tolerance > 0, "tolerance", method.tolerance, "a positive number");
  require(method.max_iterations >= 1, "max-iterations", method.max_iterations, "at least 1");
}

double lambda_of(const RobustPca& method, Index rows, Index columns) {
  if (method.lambda > 0) return method.lambda;
  return method.lambda_scale / std::sqrt(static_cast<double>(std::max(rows, columns)));
}

std::string to_string(UpdateOrder order) { return order == UpdateOrder::ae ? "ae" : "ea"; }

UpdateOrder parse_update_order(const std::string& text) {
  if (text == "ae") return UpdateOrder::ae;
  if (text == "ea") return UpdateOrder::ea;
  throw ArgumentError(fmt::format("order is '{}', expected ae or ea", text));
}

}  // namespace moclean
