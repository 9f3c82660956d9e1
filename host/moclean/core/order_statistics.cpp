#include "moclean/core/order_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "moclean/core/sorted_window.hpp"

namespace moclean {

double quantile(std::span<double> values, double q) {
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(std::floor(place));
  std::ranges::nth_element(values, values.begin() + below);
  const double low = values[static_cast<std::size_t>(below)];
  const double part = place - static_cast<double>(below);
  if (part == 0) return low;
  return low + part * (*std::ranges::min_element(values.begin() + below + 1, values.end()) - low);
}

double median(std::span<double> values) { return quantile(values, 0.5); }

void running_median(std::span<double> samples, Index window) {
  const std::vector<double> y(samples.begin(), samples.end());
  const std::size_t reach = static_cast<std::size_t>(window) / 2;
  SortedWindow sorted;
  for (std::size_t i = 0; i < std::min(reach, y.size()); ++i) sorted.insert(y[i]);
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (i + reach < y.size()) sorted.insert(y[i + reach]);
    if (i > reach) sorted.remove(y[i - reach - 1]);
    samples[i] = sorted.median();
  }
}

}  // namespace moclean
