#include "moclean/methods/spectral/singular_value_thresholding.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {

void check(const SingularValueThresholding& method) {
  if (!(method.threshold >= 0 && std::isfinite(method.threshold)))
    throw ArgumentError(fmt::format(
        "threshold is {}, expected a positive number, or 0 for the rule", method.threshold));
}

// With x = 1 + beta + 2 sqrt(beta) cos(theta) the density sqrt((b - x) (x - a)) / (2 pi beta x) dx
// becomes g(theta) = 2 sin(theta)^2 / (pi x), theta from 0 (x = b) to pi (x = a). All of the mass
// is there for beta <= 1.
double marchenko_pastur_median(double beta) {
  constexpr int steps = 4096;
  const double h = std::numbers::pi / steps;
  const auto g = [&](double theta) {
    const double s = std::sin(theta);
    const double x = 1 + beta + 2 * std::sqrt(beta) * std::cos(theta);
    return x > 1e-12 ? 2 * s * s / (std::numbers::pi * x) : 2 / std::numbers::pi;
  };
  double mass = 0;
  for (int i = 0; i < steps; ++i) {
    const double theta = i * h;
    const double part = h / 6 * (g(theta) + 4 * g(theta + h / 2) + g(theta + h));
    if (mass + part >= 0.5) {
      const double median = theta + h * (0.5 - mass) / part;
      return 1 + beta + 2 * std::sqrt(beta) * std::cos(median);
    }
    mass += part;
  }
  return 1;  // not reached: the mass is 1
}

double threshold_factor(SingularValueThresholding::Shrink shrink, double beta) {
  const double per_median = 1 / std::sqrt(marchenko_pastur_median(beta));
  if (shrink == SingularValueThresholding::Shrink::soft) return (1 + std::sqrt(beta)) * per_median;
  const double root = std::sqrt(beta * beta + 14 * beta + 1);
  return std::sqrt(2 * (beta + 1) + 8 * beta / (beta + 1 + root)) * per_median;
}

}  // namespace moclean
