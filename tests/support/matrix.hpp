#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "moclean/core/matrix.hpp"
#include "moclean/core/random.hpp"
#include "moclean/core/segment_batch.hpp"

namespace moclean::test {

/// Of a matrix, as a parameter of tests.
struct Shape {
  Index rows, columns;
};

/// |value - expected|_F / |expected|_F; the absolute |value - expected|_F where expected is zero.
inline double relative_difference(const ConstMatrixRef& value, const ConstMatrixRef& expected) {
  const double norm = expected.norm();
  return (value - expected).norm() / (norm > 0 ? norm : 1);
}

/// Largest absolute difference of two entries.
inline double largest_difference(const ConstMatrixRef& a, const ConstMatrixRef& b) {
  return a.size() == 0 ? 0 : (a - b).cwiseAbs().maxCoeff();
}

/// Equal bits, so that NaN equals NaN and 0 differs from -0.
inline bool same_bits(std::span<const double> a, std::span<const double> b) {
  const auto bits_of = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return std::ranges::equal(a, b, {}, bits_of, bits_of);
}

/// Equal shape and equal bits.
inline bool same_bits(const Matrix& a, const Matrix& b) {
  const auto entries = [](const Matrix& m) {
    return std::span(m.data(), static_cast<std::size_t>(m.size()));
  };
  return a.rows() == b.rows() && a.cols() == b.cols() && same_bits(entries(a), entries(b));
}

/// Equal layout and equal bits, the padding included.
inline bool same_bits(const SegmentBatch& a, const SegmentBatch& b) {
  return a.columns() == b.columns() && a.first_rows() == b.first_rows() &&
         same_bits(a.storage(), b.storage());
}

/// Stacks matrices of equal width as the segments of one batch.
inline SegmentBatch batch_of(const std::vector<Matrix>& segments) {
  std::vector<Index> first_row = {0};
  for (const Matrix& segment : segments) first_row.push_back(first_row.back() + segment.rows());
  SegmentBatch batch(segments.front().cols(), std::move(first_row));
  for (std::size_t b = 0; b < segments.size(); ++b)
    batch.segment(static_cast<Index>(b)) = segments[b];
  return batch;
}

/// Independent standard normals.
inline Matrix random_matrix(Index rows, Index columns, std::uint64_t seed) {
  Random random(seed);
  Matrix matrix(rows, columns);
  for (double& entry : matrix.reshaped<Eigen::RowMajor>()) entry = random.normal();
  return matrix;
}

}  // namespace moclean::test
