#include "moclean/methods/spectral/weights.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

// Below it, relative to the largest, a singular value counts as zero. A Gram matrix cannot tell
// values below about 1e-8 from rounding.
constexpr double negligible = 1e-7;

// Weights of the singular values that are not negligible, zero for the others.
template <class Weight>
std::vector<double> weights(std::span<const double> sigma, const Weight& weight) {
  std::vector<double> f(sigma.size(), 0);
  for (std::size_t k = 0; k < sigma.size() && sigma[k] > negligible * sigma[0]; ++k)
    f[k] = weight(k);
  return f;
}

double threshold_of(const SingularValueThresholding& method, std::span<const double> sigma,
                    Index rows, Index columns) {
  if (method.threshold > 0) return method.threshold;
  const auto [least, most] = std::minmax(rows, columns);
  if (least < 3)
    throw ArgumentError(
        fmt::format("svt has no rule for {} frames x {} columns; give threshold=", rows, columns));
  const std::size_t n = sigma.size();
  if (sigma[n / 2] <= negligible * sigma[0]) return 0;  // no noise
  const double median = (sigma[(n - 1) / 2] + sigma[n / 2]) / 2;
  const double beta = static_cast<double>(least) / static_cast<double>(most);
  return threshold_factor(method.shrink, beta) * median;
}

}  // namespace

void check(const TruncatedSvd& method) {
  if (method.rank < 1)
    throw ArgumentError(fmt::format("rank is {}, expected at least 1", method.rank));
}

std::vector<double> weights_of(const TruncatedSvd& method, std::span<const double> sigma, Index,
                               Index) {
  return weights(sigma,
                 [&](std::size_t k) { return static_cast<Index>(k) < method.rank ? 1.0 : 0.0; });
}

std::vector<double> weights_of(const SingularValueThresholding& method,
                               std::span<const double> sigma, Index rows, Index columns) {
  const double tau = threshold_of(method, sigma, rows, columns);
  const bool hard = method.shrink == SingularValueThresholding::Shrink::hard;
  return weights(sigma, [&](std::size_t k) {
    if (sigma[k] <= tau) return 0.0;
    return hard ? 1.0 : 1 - tau / sigma[k];
  });
}

}  // namespace moclean
