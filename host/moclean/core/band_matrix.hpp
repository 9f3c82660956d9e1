#pragma once

#include <array>
#include <span>
#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// A symmetric matrix whose entries (i, j) are zero for |i - j| > width, or its factor.
struct BandMatrix {
  static constexpr int most_width = 3;

  int width = 0;  ///< half-bandwidth, at most most_width
  /// rows[i][k] is the entry (i, i - k), zero for i < k; of a factor L D L', L(i, i - k), and D(i)
  /// for k = 0.
  std::vector<std::array<double, most_width + 1>> rows;

  std::size_t size() const { return rows.size(); }
};

/// scale Delta'Delta, Delta the difference of the given order (1, 2, 3) over so many samples, with
/// free ends; zero where there are no more samples than that.
BandMatrix difference_penalty(std::size_t samples, int order, double scale);

/// A = L D L', in place. A is positive definite.
void factor(BandMatrix& a);

/// Solves L D L' x = b in place; x.size() is that of the matrix.
void solve(const BandMatrix& factor, std::span<double> x);

/// The entries of (L D L')^-1 within the band (Takahashi, Fagan, Chen 1973).
BandMatrix inverse_in_band(const BandMatrix& factor);

/// tr(A B) of two matrices of one size and width.
double trace_of_product(const BandMatrix& a, const BandMatrix& b);

}  // namespace moclean
