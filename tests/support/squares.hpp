#pragma once

#include <vector>

#include "moclean/linalg/batch.hpp"

#include "support/device.hpp"

namespace moclean::test {

/// One order x order matrix per segment in device layout, padding zero.
inline Buffer<double> upload_squares(const Batch& batch, const std::vector<Matrix>& matrices) {
  std::vector<double> all(batch.square_size());
  for (std::size_t b = 0; b < matrices.size(); ++b) {
    const SegmentRecord& s = batch.segment(static_cast<Index>(b));
    MatrixView(all.data() + s.square, s.order, s.order, Eigen::OuterStride<>(s.order_pitch)) =
        matrices[b];
  }
  return Buffer<double>(device(), std::span<const double>(all));
}

/// The matrices of all segments, [order x order_pitch] with their padding.
inline std::vector<Matrix> download_squares(const Batch& batch, const Buffer<double>& buffer) {
  std::vector<double> all(batch.square_size());
  buffer.read(all);
  std::vector<Matrix> squares;
  for (Index b = 0; b < batch.segments(); ++b) {
    const SegmentRecord& s = batch.segment(b);
    squares.push_back(Eigen::Map<const Matrix>(all.data() + s.square, s.order, s.order_pitch));
  }
  return squares;
}

}  // namespace moclean::test
