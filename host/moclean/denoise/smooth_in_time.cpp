#include "moclean/denoise/smooth_in_time.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr Index fewest_frames = 20, fewest_pairs = 10;
constexpr std::size_t fewest_columns = 4;
constexpr std::array<Index, 6> lags = {1, 2, 3, 4, 6, 8};
constexpr double outlying = 3;  // robust deviations
constexpr double share = 0.75, least_correlation = 0.2, least_ratio = 1;

// Median absolute deviation of a column about 0; NaN is missing. 0 without a sample.
double deviation_of(const Matrix& samples, Index column) {
  std::vector<double> sizes;
  for (const double x : samples.col(column))
    if (!std::isnan(x)) sizes.push_back(std::abs(x));
  return sizes.empty() ? 0 : deviation_per_mad * median(sizes);
}

// Autocorrelation of a column at a lag, over pairs within the bound, which is the unit; nothing for
// too few pairs.
std::optional<double> correlation(const Matrix& samples, Index column, Index lag, double bound) {
  double products = 0, before = 0, after = 0;
  Index pairs = 0;
  for (Index i = 0; i + lag < samples.rows(); ++i) {
    const double a = samples(i, column) / bound, b = samples(i + lag, column) / bound;
    if (!(std::abs(a) <= 1 && std::abs(b) <= 1)) continue;
    products += a * b;
    before += a * a;
    after += b * b;
    ++pairs;
  }
  if (pairs < fewest_pairs || !(before > 0 && after > 0)) return {};
  return products / std::sqrt(before * after);
}

}  // namespace

bool smooth_in_time(const MovingPart& part) {
  Matrix samples = part.clip.samples;  // about their own medians
  if (samples.rows() < fewest_frames) return true;
  std::vector<Index> columns;
  std::vector<double> deviations, middles;
  for (Index c = 0; c < samples.cols(); ++c) {
    const Index own = part.columns[static_cast<std::size_t>(c)];
    samples.col(c).array() -= (part.medians(own) - part.centre(own)) / part.unit;
    const double deviation = deviation_of(samples, c);
    if (!(deviation > 0)) continue;
    columns.push_back(c);
    deviations.push_back(deviation);
    middles.push_back(part.medians(own) / part.unit);
  }
  if (columns.size() < fewest_columns) return true;
  for (const Index lag : lags) {
    std::vector<double> found;
    for (std::size_t c = 0; c < columns.size(); ++c)
      if (const auto r = correlation(samples, columns[c], lag, outlying * deviations[c]))
        found.push_back(*r);
    if (found.size() < fewest_columns) return true;
    if (lag == 1 && quantile(found, share) <= -least_correlation) break;  // back and forth
    for (double& r : found) r = std::abs(r);
    if (quantile(found, share) >= least_correlation) return true;
  }
  const double middle = median(middles);
  for (double& x : middles) x = std::abs(x - middle);
  return median(deviations) < least_ratio * deviation_per_mad * median(middles);
}

}  // namespace moclean
