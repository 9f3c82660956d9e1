#include "moclean/filter/whittaker.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/band_matrix.hpp"
#include "moclean/core/error.hpp"
#include "moclean/core/order_statistics.hpp"
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
void check_penalty(const Filter& filter, double lambda) {
  if (!(lambda > 0 && lambda <= largest_lambda))
    throw ArgumentError(fmt::format("{}: lambda is {}, expected a positive number up to {}",
                                    Filter::name, lambda, largest_lambda));
  if (filter.difference < 1 || filter.difference > BandMatrix::most_width)
    throw ArgumentError(
        fmt::format("{}: difference is {}, expected 1, 2 or 3", Filter::name, filter.difference));
}

struct Ranges {
  double usual;  // of 95 % of the samples: gross errors do not stretch it
  double whole;
};

Ranges ranges_of(std::span<const double> channel) {
  constexpr double left_out = 0.025;
  std::vector<double> seen;
  std::ranges::copy_if(channel, std::back_inserter(seen), [](double y) { return !std::isnan(y); });
  return {quantile(seen, 1 - left_out) - quantile(seen, left_out),
          std::ranges::max(seen) - std::ranges::min(seen)};
}

// What a channel divided by 2^exponent is smoothed with, see RobustWhittaker.
struct Penalty {
  double lambda, delta;
};

Penalty penalty_of(const RobustWhittaker& filter, const Ranges& ranges, int exponent) {
  constexpr double ratio = 1000,
                   least_share = 1e-6;            // of the whole range: no more than 1e9 / range
  constexpr double least = 1e-200, most = 1e200;  // leaves room for their products
  const double range = std::max(std::ldexp(ranges.usual, -exponent),
                                least_share * std::ldexp(ranges.whole, -exponent));
  const auto given = [&](const std::optional<double>& value, int power, double otherwise) {
    return value ? std::clamp(std::ldexp(*value, power), least, most) : otherwise;
  };
  return {given(filter.lambda, exponent, ratio / range),
          given(filter.delta, -exponent, range / ratio)};
}

// The gradient sign(z - y) + 2 lambda Delta'Delta z vanishes where (W + 2 lambda Delta'Delta) z =
// Wy.
void smooth(const RobustWhittaker& filter, const Penalty& penalty, std::span<double> channel) {
  const auto order = static_cast<int>(filter.difference);
  Weighted data = weighted(channel);
  if (data.observed <= filter.difference) return;
  const auto [lambda, delta] = penalty;
  const BandMatrix band = difference_penalty(data.y.size(), order, 2 * lambda);
  for (double& w : data.w) w *= lambda / 100;
  std::vector<double> z = solve(band, data.w, data.y);
  const double least_weight = lambda / largest_lambda;
  double moved = delta;
  for (int i = 0; i < filter.iterations && moved > delta / 1000; ++i) {
    for (std::size_t t = 0; t < z.size(); ++t)
      if (data.w[t] > 0)
        data.w[t] = std::max(1 / std::max(std::abs(data.y[t] - z[t]), delta), least_weight);
    const std::vector<double> next = solve(band, data.w, data.y);
    moved = 0;
    for (std::size_t t = 0; t < z.size(); ++t) moved = std::max(moved, std::abs(next[t] - z[t]));
    z = next;
  }
  put(z, channel);
}

}  // namespace

void check(const Whittaker& filter) { check_penalty(filter, filter.lambda); }

void check(const RobustWhittaker& filter) {
  check_penalty(filter, filter.lambda.value_or(1));
  if (const double delta = filter.delta.value_or(1); !(delta > 0 && std::isfinite(delta)))
    throw ArgumentError(
        fmt::format("whittaker-l1: delta is {}, expected a positive number", delta));
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

void smooth(const RobustWhittaker& filter, double, std::span<double> channel) {
  channel = between_ends(channel);
  const Ranges ranges = channel.empty() ? Ranges{} : ranges_of(channel);
  if (ranges.whole == 0) return;  // a constant
  const int exponent = std::ilogb(ranges.whole);
  scale_by_power(channel, -exponent);
  smooth(filter, penalty_of(filter, ranges, exponent), channel);
  scale_by_power(channel, exponent);
}

}  // namespace moclean
