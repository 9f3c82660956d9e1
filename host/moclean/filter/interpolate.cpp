#include "moclean/filter/interpolate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "moclean/core/band_matrix.hpp"
#include "moclean/filter/observed.hpp"

namespace moclean {
namespace {

// The observed samples of a channel, at least two. Time is counted in frames.
struct Knots {
  std::vector<std::size_t> frame;
  std::vector<double> y;
  std::vector<double> step;    // step[i] = frame[i + 1] - frame[i]
  std::vector<double> secant;  // secant[i] = (y[i + 1] - y[i]) / step[i]

  std::size_t intervals() const { return step.size(); }
};

Knots knots_of(std::span<const double> channel) {
  Knots knots;
  for (std::size_t f = 0; f < channel.size(); ++f) {
    if (std::isnan(channel[f])) continue;
    knots.frame.push_back(f);
    knots.y.push_back(channel[f]);
  }
  for (std::size_t i = 0; i + 1 < knots.y.size(); ++i) {
    knots.step.push_back(static_cast<double>(knots.frame[i + 1] - knots.frame[i]));
    knots.secant.push_back((knots.y[i + 1] - knots.y[i]) / knots.step[i]);
  }
  return knots;
}

// Sixths of the second derivative c of the natural spline at every knot: zero at the ends, else
//   step[i-1] c[i-1] + 2 (step[i-1] + step[i]) c[i] + step[i] c[i+1] = secant[i] - secant[i-1].
std::vector<double> natural_curvature(const Knots& knots) {
  const std::size_t inner = knots.intervals() - 1;
  BandMatrix a{.width = 1, .rows = {}};
  std::vector<double> x(inner);
  for (std::size_t i = 0; i < inner; ++i) {
    const double before = knots.step[i], after = knots.step[i + 1];
    a.rows.push_back({2 * (before + after), i == 0 ? 0 : before, 0, 0});
    x[i] = knots.secant[i + 1] - knots.secant[i];
  }
  factor(a);
  solve(a, x);
  x.insert(x.begin(), 0);
  x.push_back(0);
  return x;
}

std::vector<double> spline_slopes(const Knots& knots) {
  const std::vector<double> c = natural_curvature(knots);
  std::vector<double> slopes;
  for (std::size_t i = 0; i < knots.intervals(); ++i)
    slopes.push_back(knots.secant[i] - knots.step[i] * (2 * c[i] + c[i + 1]));
  const std::size_t last = knots.intervals() - 1;
  slopes.push_back(knots.secant[last] + knots.step[last] * (c[last] + 2 * c[last + 1]));
  return slopes;
}

// Slope at an end: of the parabola through three knots, but not against the first secant, and no
// steeper than three times it where the second one turns back. `near` is the interval at the end.
double end_slope(const Knots& knots, std::size_t near, std::size_t next) {
  const double h = knots.step[near], m = knots.secant[near], other = knots.secant[next];
  const double slope = ((2 * h + knots.step[next]) * m - h * other) / (h + knots.step[next]);
  if (!(slope * m > 0)) return 0;
  if (m * other <= 0 && std::abs(slope) > 3 * std::abs(m)) return 3 * m;
  return slope;
}

std::vector<double> monotone_slopes(const Knots& knots) {
  const std::size_t last = knots.intervals() - 1;
  if (last == 0) return {knots.secant[0], knots.secant[0]};
  std::vector<double> slopes = {end_slope(knots, 0, 1)};
  for (std::size_t i = 1; i <= last; ++i) {
    const double before = knots.secant[i - 1], after = knots.secant[i];
    const bool turns = !(before > 0 && after > 0) && !(before < 0 && after < 0);
    const double w = 2 * knots.step[i] + knots.step[i - 1];
    const double v = knots.step[i] + 2 * knots.step[i - 1];
    slopes.push_back(turns ? 0 : (w + v) / (w / before + v / after));
  }
  slopes.push_back(end_slope(knots, last, last - 1));
  return slopes;
}

// Fills the frames between knots i and i + 1 by the cubic with the slopes `left` and `right` there;
// with those of the secant it is the straight line.
void fill(const Knots& knots, std::size_t i, double left, double right, std::span<double> channel) {
  const double h = knots.step[i], m = knots.secant[i];
  const double square = (2 * (m - left) + (m - right)) / h;
  const double cube = ((left - m) + (right - m)) / (h * h);
  for (std::size_t f = knots.frame[i] + 1; f < knots.frame[i + 1]; ++f) {
    const auto t = static_cast<double>(f - knots.frame[i]);
    channel[f] = knots.y[i] + t * (left + t * (square + t * cube));
  }
}

}  // namespace

void smooth(const Interpolate& filter, double, std::span<double> channel) {
  const std::span<double> inner = between_ends(channel);
  if (inner.empty()) return;
  const auto before = static_cast<std::size_t>(inner.data() - channel.data());
  std::ranges::fill(channel.first(before), inner.front());
  std::ranges::fill(channel.subspan(before + inner.size()), inner.back());
  const Knots knots = knots_of(inner);
  if (knots.intervals() + 1 == inner.size()) return;  // no gap
  const bool straight = filter.kind == Interpolate::Kind::linear;
  const std::vector<double> slopes = straight ? knots.secant
                                     : filter.kind == Interpolate::Kind::cubic
                                         ? spline_slopes(knots)
                                         : monotone_slopes(knots);
  for (std::size_t i = 0; i < knots.intervals(); ++i)
    fill(knots, i, slopes[i], straight ? slopes[i] : slopes[i + 1], inner);
}

}  // namespace moclean
