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

}  // namespace moclean
