#pragma once

#include <span>
#include <vector>

#include "moclean/core/large_memory.hpp"
#include "moclean/core/matrix.hpp"

namespace moclean {

/// Columns are padded to a multiple of this many numbers: whole cache lines, and a whole number of
/// the widest vectors (8 doubles, 16 floats) a device loads at once.
inline constexpr Index pitch_multiple = 16;

/// Smallest pitch that holds `columns`: the next multiple of `pitch_multiple`.
constexpr Index padded(Index columns) {
  return (columns + pitch_multiple - 1) / pitch_multiple * pitch_multiple;
}

/// All frames of all segments stacked in one tall row-major matrix [rows() x pitch()].
///
/// Segment b owns the rows first_row(b) up to first_row(b + 1); segments may differ in length but
/// share the number of columns. The padding columns() .. pitch() - 1 is zero, and every writer
/// keeps it zero: kernels rely on it. This is the one home of the memory layout; device buffers
/// copy it byte for byte.
class SegmentBatch {
 public:
  SegmentBatch() = default;

  /// A zero batch. `first_row` holds segments + 1 strictly increasing entries starting at 0;
  /// throws ShapeError otherwise, or if columns < 1.
  SegmentBatch(Index columns, std::vector<Index> first_row);

  Index segments() const { return static_cast<Index>(first_row_.size()) - 1; }
  Index columns() const { return columns_; }
  Index pitch() const { return padded(columns_); }
  Index rows() const { return first_row_.back(); }
  Index rows(Index segment) const { return first_row(segment + 1) - first_row(segment); }
  Index first_row(Index segment) const { return first_row_[static_cast<std::size_t>(segment)]; }
  const std::vector<Index>& first_rows() const { return first_row_; }

  /// Rows of one segment without the padding, [rows(segment) x columns()].
  MatrixView segment(Index segment);
  ConstMatrixView segment(Index segment) const;

  /// Any run of rows without the padding, [count x columns()].
  MatrixView block(Index first, Index count);
  ConstMatrixView block(Index first, Index count) const;

  /// The raw storage with padding, rows() * pitch() doubles.
  std::span<double> storage() { return storage_; }
  std::span<const double> storage() const { return storage_; }

 private:
  Index columns_ = 0;
  std::vector<Index> first_row_ = {0};
  std::vector<double, LargeAllocator<double>> storage_;  // [rows x pitch]
};

}  // namespace moclean
