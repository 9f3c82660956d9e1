#include "moclean/filter/whittaker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/filter/observed.hpp"

namespace moclean {
namespace {

constexpr Index most_differences = 3;

// Coefficients of the difference of order 1, 2, 3.
constexpr std::array<std::array<double, most_differences + 1>, most_differences> differences = {
    {{-1, 1}, {1, -2, 1}, {-1, 3, -3, 1}}};

// A symmetric band matrix: band[i][k] is the entry (i, i - k).
using Band = std::vector<std::array<double, most_differences + 1>>;

// lambda Delta'Delta for n samples.
Band penalty(std::size_t n, double lambda, std::size_t order) {
  Band band(n, {0, 0, 0, 0});
  const auto& c = differences[order - 1];
  for (std::size_t row = 0; row + order < n; ++row)
    for (std::size_t i = 0; i <= order; ++i)
      for (std::size_t k = 0; k <= i; ++k) band[row + i][k] += lambda * c[i] * c[i - k];
  return band;
}

// Solves (penalty + diag(w)) z = diag(w) y by the factors L D L' of the band; y = 0 where w = 0.
std::vector<double> solve(Band a, std::size_t order, const std::vector<double>& w,
                          const std::vector<double>& y) {
  const std::size_t n = y.size();
  std::vector<double> z(n);
  for (std::size_t i = 0; i < n; ++i) {
    a[i][0] += w[i];
    z[i] = w[i] * y[i];
    const std::size_t first = i < order ? 0 : i - order;
    for (std::size_t j = first; j < i; ++j) {  // a(i, j) becomes L(i, j) D(j)
      for (std::size_t k = first; k < j; ++k) {
        if (j - k > order) continue;
        a[i][i - j] -= a[i][i - k] * a[j][j - k];
      }
    }
    for (std::size_t j = first; j < i; ++j) {
      const double l = a[i][i - j] / a[j][0];
      a[i][0] -= l * a[i][i - j];
      a[i][i - j] = l;
      z[i] -= l * z[j];
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    z[i] /= a[i][0];
    for (std::size_t j = i + 1; j <= std::min(n - 1, i + order); ++j) z[i] -= a[j][j - i] * z[j];
  }
  return z;
}

// A channel between its ends, gaps as samples of weight 0.
struct Weighted {
  std::vector<double> y, w;
  std::size_t observed = 0;
};

Weighted weighted(std::span<const double> channel) {
  Weighted result;
  for (const double x : channel) {
    const bool seen = !std::isnan(x);
    result.y.push_back(seen ? x : 0);
    result.w.push_back(seen ? 1 : 0);
    result.observed += seen;
  }
  return result;
}

void put(const std::vector<double>& z, std::span<double> channel) {
  for (std::size_t i = 0; i < z.size(); ++i)
    if (!std::isnan(channel[i])) channel[i] = z[i];
}

template <class Filter>
void check_penalty(const Filter& filter) {
  if (!(filter.lambda > 0 && std::isfinite(filter.lambda)))
    throw ArgumentError(
        fmt::format("{}: lambda is {}, expected a positive number", Filter::name, filter.lambda));
  if (filter.difference < 1 || filter.difference > most_differences)
    throw ArgumentError(
        fmt::format("{}: difference is {}, expected 1, 2 or 3", Filter::name, filter.difference));
}

}  // namespace

void check(const Whittaker& filter) { check_penalty(filter); }

void check(const RobustWhittaker& filter) {
  check_penalty(filter);
  if (!(filter.delta > 0 && std::isfinite(filter.delta)))
    throw ArgumentError(
        fmt::format("whittaker-l1: delta is {}, expected a positive number", filter.delta));
  if (filter.iterations < 1)
    throw ArgumentError(
        fmt::format("whittaker-l1: iterations is {}, expected at least 1", filter.iterations));
}

void smooth(const Whittaker& filter, double, std::span<double> channel) {
  channel = between_ends(channel);
  const auto order = static_cast<std::size_t>(filter.difference);
  const Weighted data = weighted(channel);
  if (data.observed <= order) return;
  put(solve(penalty(data.y.size(), filter.lambda, order), order, data.w, data.y), channel);
}

// The gradient sign(z - y) + 2 lambda Delta'Delta z vanishes where (W + 2 lambda Delta'Delta) z =
// Wy.
void smooth(const RobustWhittaker& filter, double, std::span<double> channel) {
  channel = between_ends(channel);
  const auto order = static_cast<std::size_t>(filter.difference);
  Weighted data = weighted(channel);
  if (data.observed <= order) return;
  const Band band = penalty(data.y.size(), 2 * filter.lambda, order);
  std::vector<double> z = solve(band, order, data.w, data.y);
  double moved = filter.delta;
  for (int i = 0; i < filter.iterations && moved > filter.delta / 1000; ++i) {
    for (std::size_t t = 0; t < z.size(); ++t)
      if (data.w[t] > 0) data.w[t] = 1 / std::max(std::abs(data.y[t] - z[t]), filter.delta);
    const std::vector<double> next = solve(band, order, data.w, data.y);
    moved = 0;
    for (std::size_t t = 0; t < z.size(); ++t) moved = std::max(moved, std::abs(next[t] - z[t]));
    z = next;
  }
  put(z, channel);
}

}  // namespace moclean
