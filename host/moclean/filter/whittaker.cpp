#include "moclean/filter/whittaker.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/band_matrix.hpp"
#include "moclean/core/error.hpp"
#include "moclean/filter/observed.hpp"

namespace moclean {
namespace {

// Solves (penalty + diag(w)) z = diag(w) y; y = 0 where w = 0.
std::vector<double> solve(BandMatrix a, const std::vector<double>& w,
                          const std::vector<double>& y) {
  std::vector<double> z(y.size());
  for (std::size_t i = 0; i < y.size(); ++i) {
    a.rows[i][0] += w[i];
    z[i] = w[i] * y[i];
  }
  factor(a);
  moclean::solve(a, z);
  return z;
}

// A channel between its ends, gaps as samples of weight 0.
struct Weighted {
  std::vector<double> y, w;
  Index observed = 0;
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

// The condition of the system is about 16 lambda (64 for differences of order 3).
constexpr double largest_lambda = 1e10;

template <class Filter>
void check_penalty(const Filter& filter) {
  if (!(filter.lambda > 0 && filter.lambda <= largest_lambda))
    throw ArgumentError(fmt::format("{}: lambda is {}, expected a positive number up to {}",
                                    Filter::name, filter.lambda, largest_lambda));
  if (filter.difference < 1 || filter.difference > BandMatrix::most_width)
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
  constexpr int most_iterations = 10'000;
  if (filter.iterations < 1 || filter.iterations > most_iterations)
    throw ArgumentError(fmt::format("whittaker-l1: iterations is {}, expected 1 to {}",
                                    filter.iterations, most_iterations));
}

void smooth(const Whittaker& filter, double, std::span<double> channel) {
  channel = between_ends(channel);
  const auto order = static_cast<int>(filter.difference);
  const Weighted data = weighted(channel);
  if (data.observed <= filter.difference) return;
  put(solve(difference_penalty(data.y.size(), order, filter.lambda), data.w, data.y), channel);
}

// The gradient sign(z - y) + 2 lambda Delta'Delta z vanishes where (W + 2 lambda Delta'Delta) z =
// Wy.
void smooth(const RobustWhittaker& filter, double, std::span<double> channel) {
  channel = between_ends(channel);
  const auto order = static_cast<int>(filter.difference);
  Weighted data = weighted(channel);
  if (data.observed <= filter.difference) return;
  const BandMatrix band = difference_penalty(data.y.size(), order, 2 * filter.lambda);
  std::vector<double> z = solve(band, data.w, data.y);
  const double least_weight = filter.lambda / largest_lambda;
  double moved = filter.delta;
  for (int i = 0; i < filter.iterations && moved > filter.delta / 1000; ++i) {
    for (std::size_t t = 0; t < z.size(); ++t)
      if (data.w[t] > 0)
        data.w[t] = std::max(1 / std::max(std::abs(data.y[t] - z[t]), filter.delta), least_weight);
    const std::vector<double> next = solve(band, data.w, data.y);
    moved = 0;
    for (std::size_t t = 0; t < z.size(); ++t) moved = std::max(moved, std::abs(next[t] - z[t]));
    z = next;
  }
  put(z, channel);
}

}  // namespace moclean
