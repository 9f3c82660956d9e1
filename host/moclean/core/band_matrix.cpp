#include "moclean/core/band_matrix.hpp"

#include <algorithm>

namespace moclean {
namespace {

// Coefficients of the difference of order 1, 2, 3.
constexpr std::array<std::array<double, BandMatrix::most_width + 1>, BandMatrix::most_width>
    differences = {{{-1, 1}, {1, -2, 1}, {-1, 3, -3, 1}}};

}  // namespace

BandMatrix difference_penalty(std::size_t samples, int order, double scale) {
  BandMatrix a{.width = order, .rows = {}};
  a.rows.resize(samples, {0, 0, 0, 0});
  const auto width = static_cast<std::size_t>(order);
  const auto& c = differences[width - 1];
  for (std::size_t row = 0; row + width < samples; ++row)
    for (std::size_t i = 0; i <= width; ++i)
      for (std::size_t k = 0; k <= i; ++k) a.rows[row + i][k] += scale * c[i] * c[i - k];
  return a;
}

void factor(BandMatrix& a) {
  const auto width = static_cast<std::size_t>(a.width);
  auto& r = a.rows;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const std::size_t first = i < width ? 0 : i - width;
    for (std::size_t j = first; j < i; ++j)  // a(i, j) becomes L(i, j) D(j)
      for (std::size_t k = first; k < j; ++k) r[i][i - j] -= r[i][i - k] * r[j][j - k];
    for (std::size_t j = first; j < i; ++j) {
      const double l = r[i][i - j] / r[j][0];
      r[i][0] -= l * r[i][i - j];
      r[i][i - j] = l;
    }
  }
}

void solve(const BandMatrix& factor, std::span<double> x) {
  const auto width = static_cast<std::size_t>(factor.width);
  const auto& r = factor.rows;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = i < width ? 0 : i - width; j < i; ++j) x[i] -= r[i][i - j] * x[j];
  for (std::size_t i = x.size(); i-- > 0;) {
    x[i] /= r[i][0];
    for (std::size_t j = i + 1; j <= std::min(x.size() - 1, i + width); ++j)
      x[i] -= r[j][j - i] * x[j];
  }
}

// Z = (L D L')^-1 solves Z = D^-1 L^-1 + (I - L') Z, of which the first term has no entries above
// the diagonal: from the last row on, each entry of the band follows from those after it.
BandMatrix inverse_in_band(const BandMatrix& factor) {
  const auto width = static_cast<std::size_t>(factor.width);
  const auto& r = factor.rows;
  const std::size_t n = r.size();
  BandMatrix inverse{.width = factor.width, .rows = {}};
  inverse.rows.resize(n, {0, 0, 0, 0});
  const auto entry = [&](std::size_t i, std::size_t j) -> double& {
    return inverse.rows[std::max(i, j)][std::max(i, j) - std::min(i, j)];
  };
  for (std::size_t i = n; i-- > 0;) {
    const std::size_t last = std::min(n - 1, i + width);
    for (std::size_t j = last + 1; j-- > i;) {
      double sum = j == i ? 1 / r[i][0] : 0;
      for (std::size_t k = i + 1; k <= last; ++k) sum -= r[k][k - i] * entry(k, j);
      entry(i, j) = sum;
    }
  }
  return inverse;
}

double trace_of_product(const BandMatrix& a, const BandMatrix& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += a.rows[i][0] * b.rows[i][0];
    for (std::size_t k = 1; k <= static_cast<std::size_t>(a.width); ++k)
      sum += 2 * a.rows[i][k] * b.rows[i][k];
  }
  return sum;
}

}  // namespace moclean
