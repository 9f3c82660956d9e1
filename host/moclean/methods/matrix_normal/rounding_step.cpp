#include "moclean/methods/matrix_normal/rounding_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace moclean {
namespace {

constexpr std::size_t most_differences = 4096, least_differences = 50;
constexpr double longest = 20;         // steps: of differences that are looked at, errors add up
constexpr double near_multiple = 0.1;  // steps
constexpr double least_share = 0.6;    // of the differences, near a multiple: by chance 0.2

// Magnitudes of second differences that are above `smallest`, sorted; a share of them if many. None
// if they have one sign: a motion of constant acceleration is no lattice.
std::vector<double> sorted_differences(const ConstMatrixRef& data, double smallest) {
  std::vector<double> all;
  std::size_t positive = 0;
  for (Index i = 0; i + 2 < data.rows(); ++i)
    for (Index j = 0; j < data.cols(); ++j) {
      const double d = data(i, j) - 2 * data(i + 1, j) + data(i + 2, j);
      if (!(std::abs(d) > smallest)) continue;  // or NaN
      all.push_back(std::abs(d));
      positive += d > 0;
    }
  if (std::min(positive, all.size() - positive) < all.size() / 10) return {};
  const std::size_t every = all.size() / most_differences + 1;
  std::size_t count = 0;
  for (std::size_t k = 0; k < all.size(); k += every) all[count++] = all[k];
  all.resize(count);
  std::ranges::sort(all);
  return all;
}

// How many of the sorted values follow each within `width`.
std::vector<std::size_t> crowds(std::span<const double> sorted, double width) {
  std::vector<std::size_t> count(sorted.size());
  std::size_t last = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    while (last < sorted.size() && sorted[last] <= sorted[k] + width) ++last;
    count[k] = last - k;
  }
  return count;
}

// The smallest value that many of the sorted ones share up to `width`.
double first_crowd(std::span<const double> sorted, double width) {
  const std::vector<std::size_t> count = crowds(sorted, width);
  const std::size_t enough = *std::ranges::max_element(count) / 4;
  std::size_t k = 0;
  while (count[k] < enough) ++k;
  while (k + 1 < count.size() && count[k + 1] > count[k]) ++k;
  double sum = 0;
  for (std::size_t i = k; i < k + count[k]; ++i) sum += sorted[i];
  return sum / static_cast<double>(count[k]);
}

// Whether most of the values are multiples of `step`.
bool are_multiples(std::span<const double> sorted, double step) {
  std::size_t looked_at = 0, near = 0;
  for (const double d : sorted) {
    const double multiple = d / step, whole = std::round(multiple);
    if (multiple > longest) break;
    ++looked_at;
    near += whole >= 1 && std::abs(multiple - whole) <= near_multiple;
  }
  return looked_at >= least_differences &&
         static_cast<double>(near) >= least_share * static_cast<double>(looked_at);
}

}  // namespace

double rounding_step(const ConstMatrixRef& data) {
  // Differences of four roundings: exact, single precision, six digits.
  constexpr std::array errors = {1e-10, 2e-7, 1e-5};
  double largest = 0, step = 0;
  for (Index i = 0; i < data.rows(); ++i)
    for (Index j = 0; j < data.cols(); ++j)
      if (std::abs(data(i, j)) > largest) largest = std::abs(data(i, j));
  for (const double error : errors) {
    const double width = error * largest;
    const std::vector<double> differences = sorted_differences(data, 10 * width);
    if (differences.size() < least_differences) continue;
    const double found = first_crowd(differences, width);
    if (found > 10 * width && are_multiples(differences, found)) step = std::max(step, found);
  }
  return step;
}

double rounding_deviation(const ConstMatrixRef& data) {
  return rounding_step(data) / std::sqrt(12.);
}

}  // namespace moclean
