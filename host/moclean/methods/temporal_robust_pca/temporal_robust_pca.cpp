#include "moclean/methods/temporal_robust_pca/temporal_robust_pca.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/solve/missing.hpp"

namespace moclean {
namespace {

constexpr double lower_quartile = 0.318639;  // of |x| for a standard normal x
constexpr std::array second = {1.0, -2.0, 1.0};
constexpr std::array fourth = {1.0, -4.0, 6.0, -4.0, 1.0};

void require(const char* name, double value, bool valid, const char* expected) {
  if (!valid || !std::isfinite(value))
    throw ArgumentError(fmt::format("{} is {}, expected {}", name, value, expected));
}

// Magnitudes of a difference over observed samples that are `lag` rows apart.
std::vector<double> differences(const ConstMatrixRef& data, Index column,
                                std::span<const double> coefficients, Index lag) {
  const auto terms = static_cast<Index>(coefficients.size());
  std::vector<double> found;
  for (Index i = 0; i + (terms - 1) * lag < data.rows(); ++i) {
    double sum = 0;
    for (Index k = 0; k < terms; ++k)
      sum += coefficients[static_cast<std::size_t>(k)] * data(i + k * lag, column);
    if (!std::isnan(sum)) found.push_back(std::abs(sum));
  }
  return found;
}

// Root mean square over the columns of the standard deviation that the lower quartile suggests.
double deviation(const ConstMatrixRef& data, std::span<const double> coefficients, Index lag) {
  double squares = 0;
  Index columns = 0;
  for (Index j = 0; j < data.cols(); ++j) {
    std::vector<double> found = differences(data, j, coefficients, lag);
    if (found.empty()) continue;
    const auto quartile = found.begin() + static_cast<std::ptrdiff_t>((found.size() - 1) / 4);
    std::ranges::nth_element(found, quartile);
    squares += *quartile / lower_quartile * (*quartile / lower_quartile);
    ++columns;
  }
  return columns == 0 ? 0 : std::sqrt(squares / static_cast<double>(columns));
}

}  // namespace

void check(const TemporalRobustPca& method) {
  constexpr double most = 1e10;  // beyond, what is added to it is lost in rounding
  require("gamma", method.gamma, method.gamma >= 0 && method.gamma <= most,
          "0 (by rule) or a positive number up to 1e10");
  require("nu", method.nu, method.nu > 0, "a positive number");
  require("lambda", method.lambda, method.lambda >= 0 && method.lambda <= most,
          "0 (by size) or a positive number up to 1e10");
  require("lambda-scale", method.lambda_scale,
          method.lambda_scale > 0 && method.lambda_scale <= most, "a positive number up to 1e10");
  require("rho", method.rho, method.rho > 1, "a number above 1");
  require("mu0-factor", method.mu0_factor, method.mu0_factor > 0, "a positive number");
  require("mu-max-factor", method.mu_max_factor, method.mu_max_factor >= 1, "at least 1");
  require("tolerance", method.tolerance, method.tolerance > 0, "a positive number");
  if (method.max_iterations < 1)
    throw ArgumentError(
        fmt::format("max-iterations is {}, expected at least 1", method.max_iterations));
}

double penalty_of(const ConstMatrixRef& data, double lambda) {
  constexpr Index lag = 8, enough_rows = 32;
  const double size = observed_part(data).norm() / std::sqrt(static_cast<double>(data.size()));
  double motion = deviation(data, second, 1);
  if (data.rows() >= enough_rows) {
    const double slow = deviation(data, second, lag) / (lag * lag);
    motion = std::clamp(motion, slow, 10 * slow);
  }
  motion = std::max(motion, 1e-6 * size);
  if (motion == 0) return 0;
  const double noise = deviation(data, fourth, 1) / std::sqrt(70.0);  // 1 + 16 + 36 + 16 + 1
  return lambda * (motion + noise) / (motion * motion);
}

TemporalStart start_temporal(const ConstMatrixRef& data, const TemporalRobustPca& method) {
  TemporalStart start;
  start.data = filled_along_time(data);
  start.observed = observed_entries(data);
  start.norm = observed_part(data).norm();
  start.lambda = method.lambda > 0
                     ? method.lambda
                     : method.lambda_scale /
                           std::sqrt(static_cast<double>(std::max(data.rows(), data.cols())));
  start.gamma = method.gamma > 0 ? method.gamma : penalty_of(data, start.lambda);
  return start;
}

}  // namespace moclean
