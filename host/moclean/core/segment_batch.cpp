#include "moclean/core/segment_batch.hpp"

#include <string>

#include "moclean/core/error.hpp"

namespace moclean {

SegmentBatch::SegmentBatch(Index columns, std::vector<Index> first_row)
    : columns_(columns), first_row_(std::move(first_row)) {
  if (columns_ < 1)
    throw ShapeError("a batch needs at least one column, got " + std::to_string(columns_));
  if (first_row_.empty() || first_row_.front() != 0)
    throw ShapeError("first_row of a batch has to start with 0");
  for (std::size_t b = 1; b < first_row_.size(); ++b)
    if (first_row_[b] <= first_row_[b - 1])
      throw ShapeError("segment " + std::to_string(b - 1) + " of a batch has no rows");
  storage_.resize(static_cast<std::size_t>(rows() * pitch()));
}

MatrixView SegmentBatch::block(Index first, Index count) {
  return {storage_.data() + first * pitch(), count, columns_, Eigen::OuterStride<>(pitch())};
}

ConstMatrixView SegmentBatch::block(Index first, Index count) const {
  return {storage_.data() + first * pitch(), count, columns_, Eigen::OuterStride<>(pitch())};
}

MatrixView SegmentBatch::segment(Index segment) { return block(first_row(segment), rows(segment)); }

ConstMatrixView SegmentBatch::segment(Index segment) const {
  return block(first_row(segment), rows(segment));
}

}  // namespace moclean
