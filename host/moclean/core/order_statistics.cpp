#include "moclean/core/order_statistics.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "moclean/core/sorted_window.hpp"

namespace moclean {

namespace {

// Two values that most likely have the order statistic `place` of many values between them:
// order statistics of a sample, three deviations sqrt(size / 4) to either side. So have they an
// eighth of all values with a sample of 512, a third with one of 64.
template <std::size_t size, std::size_t margin>
std::pair<double, double> bracket(std::span<const double> values, std::size_t place) {
  std::array<double, size> sample{};
  const std::size_t step = values.size() / size;
  for (std::size_t i = 0; i < size; ++i) sample[i] = values[i * step];
  std::ranges::sort(sample);
  const std::size_t middle = place * size / values.size();
  return {sample[middle - std::min(middle, margin)], sample[std::min(middle + margin, size - 1)]};
}

// The order statistics `place` and `place` + 1 (the former again if it is the last). Reorders.
std::pair<double, double> neighbours(std::span<double> values, std::size_t place) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::ranges::nth_element(values, at);
  const bool last = place + 1 == values.size();
  return {*at, last ? *at : *std::ranges::min_element(at + 1, values.end())};
}

// The same of many values, in one pass over them without branches; empty if the bracket is wrong.
std::optional<std::pair<double, double>> neighbours_of_many(std::span<const double> values,
                                                            std::size_t place) {
  constexpr std::size_t very_many = 4096;
  const auto [low, high] =
      values.size() < very_many ? bracket<64, 12>(values, place) : bracket<512, 34>(values, place);
  std::vector<double> between(values.size());
  std::size_t below = 0, count = 0;
  for (const double x : values) {
    between[count] = x;
    below += x < low;
    count += x >= low && x <= high;
  }
  if (place < below || place + 1 >= below + count) return {};
  return neighbours(std::span(between).first(count), place - below);
}

}  // namespace

double quantile(std::span<double> values, double q) {
  constexpr std::size_t many = 512;
  const double exact = q * static_cast<double>(values.size() - 1);
  const auto place = static_cast<std::size_t>(exact);
  std::optional<std::pair<double, double>> found;
  if (values.size() >= many) found = neighbours_of_many(values, place);
  const auto [low, high] = found ? *found : neighbours(values, place);
  const double part = exact - static_cast<double>(place);
  return part == 0 ? low : low + part * (high - low);
}

double median(std::span<double> values) { return quantile(values, 0.5); }

void running_median(std::span<double> samples, Index window) {
  const std::vector<double> y(samples.begin(), samples.end());
  const std::size_t half = static_cast<std::size_t>(window) / 2;
  SortedWindow sorted;
  for (std::size_t i = 0; i < std::min(half, y.size()); ++i) sorted.insert(y[i]);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const bool enters = i + half < y.size();
    const bool leaves = i > half;
    if (enters && leaves)
      sorted.replace(y[i - half - 1], y[i + half]);
    else if (enters)
      sorted.insert(y[i + half]);
    else if (leaves)
      sorted.remove(y[i - half - 1]);
    samples[i] = sorted.median();
  }
}

}  // namespace moclean
