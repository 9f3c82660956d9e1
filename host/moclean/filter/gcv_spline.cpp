// Notation: y samples at the times t, n of them; m order of the penalised derivative; column i of Q
// [n x n - m] takes the divided difference of order m over t_i .. t_i+m, which is the integral of
// s^(m) times M_i / m!, M_i the B-spline of order m of integral 1 on these knots; R_ij = integral
// of M_i M_j. So, p' = p (m!)^2,
//   (R + p' Q'Q) w = Q'y,   s = y - p' Q w,   I - A = p' Q (R + p' Q'Q)^-1 Q'
// (Reinsch 1967 for m = 2).
#include "moclean/filter/gcv_spline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/band_matrix.hpp"
#include "moclean/core/error.hpp"

namespace moclean {
namespace {

constexpr std::size_t most_order = 3;
constexpr double least_cutoff = 0.02, most_cutoff = 10;  // p^(-1 / 2 m), radians per frame
constexpr int coarse_steps = 16, fine_steps = 20;        // of the search for it

using Difference = std::array<double, most_order + 1>;

// Gauss-Legendre: exact for products of two B-splines of order 3, of degree 4.
constexpr std::array<double, 3> places = {-0.7745966692414834, 0, 0.7745966692414834};
constexpr std::array<double, 3> shares = {5. / 18, 8. / 18, 5. / 18};

// Coefficients of the divided difference over order + 1 times.
Difference divided_difference(std::span<const double> t) {
  Difference c = {};
  for (std::size_t k = 0; k < t.size(); ++k) {
    c[k] = 1;
    for (std::size_t l = 0; l < t.size(); ++l)
      if (l != k) c[k] /= t[k] - t[l];
  }
  return c;
}

// The B-spline of integral 1 on the knots t at x, by the recurrence of Curry and Schoenberg.
double b_spline(std::span<const double> t, double x) {
  const std::size_t order = t.size() - 1;
  if (x < t.front() || x >= t.back()) return 0;
  if (order == 1) return 1 / (t[1] - t[0]);
  const double k = static_cast<double>(order) / static_cast<double>(order - 1);
  return k *
         ((x - t.front()) * b_spline(t.first(order), x) +
          (t.back() - x) * b_spline(t.subspan(1), x)) /
         (t.back() - t.front());
}

// A channel's samples, and what does not depend on p.
class Channel {
 public:
  Channel(std::vector<double> times, std::vector<double> samples, std::size_t order)
      : t_(std::move(times)), y_(std::move(samples)), m_(order) {
    for (std::size_t i = 0; i < unknowns(); ++i) Q_.push_back(divided_difference(knots(i)));
    R_ = {.width = static_cast<int>(m_), .rows = {}};
    R_.rows.resize(unknowns(), {0, 0, 0, 0});
    squares_ = R_;
    for (std::size_t i = 0; i < unknowns(); ++i)
      for (std::size_t k = 0; k <= std::min(i, m_); ++k) {
        squares_.rows[i][k] = overlap_of_differences(i, k);
        if (k < m_) R_.rows[i][k] = overlap_of_splines(i, k);
      }
    differences_.resize(unknowns());
    for (std::size_t i = 0; i < unknowns(); ++i)
      for (std::size_t k = 0; k <= m_; ++k) differences_[i] += Q_[i][k] * y_[i + k];
  }

  // s; the criterion of cross-validation to `criterion`.
  std::vector<double> smoothed(double p, double& criterion) const {
    for (std::size_t k = 2; k <= m_; ++k) p *= static_cast<double>(k * k);  // p'
    BandMatrix a = R_;
    for (std::size_t i = 0; i < unknowns(); ++i)
      for (std::size_t k = 0; k <= m_; ++k) a.rows[i][k] += p * squares_.rows[i][k];
    factor(a);
    std::vector<double> w = differences_;
    solve(a, w);
    std::vector<double> off(y_.size(), 0), s(y_.size());  // y - s, s
    for (std::size_t i = 0; i < unknowns(); ++i)
      for (std::size_t k = 0; k <= m_; ++k) off[i + k] += p * Q_[i][k] * w[i];
    double residual = 0;
    for (std::size_t i = 0; i < off.size(); ++i) {
      residual += off[i] * off[i];
      s[i] = y_[i] - off[i];
    }
    const double left = p * trace_of_product(inverse_in_band(a), squares_);  // tr(I - A)
    criterion = residual / (left * left);
    return s;
  }

  std::size_t order() const { return m_; }

 private:
  std::size_t unknowns() const { return y_.size() - m_; }
  std::span<const double> knots(std::size_t i) const { return std::span(t_).subspan(i, m_ + 1); }

  // (Q'Q)(i, i - k).
  double overlap_of_differences(std::size_t i, std::size_t k) const {
    double sum = 0;
    for (std::size_t a = 0; a + k <= m_; ++a) sum += Q_[i][a] * Q_[i - k][a + k];
    return sum;
  }

  // R(i, i - k).
  double overlap_of_splines(std::size_t i, std::size_t k) const {
    double sum = 0;
    for (std::size_t a = i; a < i - k + m_; ++a) {
      const double length = t_[a + 1] - t_[a];
      for (std::size_t g = 0; g < places.size(); ++g) {
        const double x = t_[a] + length * (1 + places[g]) / 2;
        sum += shares[g] * length * b_spline(knots(i), x) * b_spline(knots(i - k), x);
      }
    }
    return sum;
  }

  std::vector<double> t_, y_;
  std::size_t m_;
  std::vector<Difference> Q_;
  BandMatrix R_, squares_;           // R, Q'Q
  std::vector<double> differences_;  // Q'y
};

// s with the p of the least criterion: the best of a grid of cut-offs, then golden sections.
std::vector<double> cross_validated(const Channel& channel) {
  double criterion = 0;
  const auto at = [&](double log_cutoff) {
    return channel.smoothed(std::exp(-2 * static_cast<double>(channel.order()) * log_cutoff),
                            criterion);
  };
  const auto value = [&](double log_cutoff) { return at(log_cutoff), criterion; };
  const double first = std::log(least_cutoff), last = std::log(most_cutoff);
  const double width = (last - first) / coarse_steps;
  double best = first, least = value(first);
  for (int i = 1; i <= coarse_steps; ++i) {
    const double log_cutoff = first + i * width, found = value(log_cutoff);
    if (found < least) best = log_cutoff;
    least = std::min(found, least);
  }
  constexpr double golden = 0.6180339887498949;
  double low = std::max(best - width, first), high = std::min(best + width, last);
  double left = high - golden * (high - low), right = low + golden * (high - low);
  double of_left = value(left), of_right = value(right);
  for (int i = 0; i < fine_steps; ++i)
    if (of_left < of_right) {
      high = std::exchange(right, left);
      of_right = of_left;
      of_left = value(left = high - golden * (high - low));
    } else {
      low = std::exchange(left, right);
      of_left = of_right;
      of_right = value(right = low + golden * (high - low));
    }
  return at((low + high) / 2);
}

}  // namespace

void check(const GcvSpline& filter) {
  if (filter.degree != 1 && filter.degree != 3 && filter.degree != 5)
    throw ArgumentError(fmt::format("gcv: degree is {}, expected 1, 3 or 5", filter.degree));
}

void smooth(const GcvSpline& filter, double, std::span<double> channel) {
  const auto order = static_cast<std::size_t>(filter.degree + 1) / 2;
  std::vector<double> times, samples;
  for (std::size_t i = 0; i < channel.size(); ++i)
    if (!std::isnan(channel[i])) {
      times.push_back(static_cast<double>(i));
      samples.push_back(channel[i]);
    }
  if (samples.size() < 2 * order) return;
  const std::vector<double> motion = cross_validated({times, std::move(samples), order});
  for (std::size_t i = 0; i < times.size(); ++i)
    channel[static_cast<std::size_t>(times[i])] = motion[i];
}

}  // namespace moclean
