#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "moclean/core/segment_batch.hpp"
#include "moclean/device/kernel.hpp"

namespace moclean {

/// Most rows of a segment that one work-item handles in a sweep; reaches the kernels as BLOCK_ROWS.
/// Each block but the first of a segment has a Gram matrix of its own until they are summed.
inline constexpr int block_rows = 256;

/// Where a segment lies in device memory; mirrors segment_t of kernels/prelude.cl.
struct SegmentRecord {
  std::int64_t first_row = 0;  ///< in the stacked matrices
  std::int64_t square = 0;     ///< offset of its order x order matrices, in reals
  std::int64_t vector = 0;     ///< offset of its vectors of `order` entries, in reals
  std::int64_t partial = 0;  ///< offset of the Gram matrices of all blocks but its first, in reals
  std::int32_t rows = 0;
  std::int32_t columns = 0;
  std::int32_t pitch = 0;
  std::int32_t order = 0;        ///< min(rows, columns): size of its Gram matrix
  std::int32_t order_pitch = 0;  ///< row to row in an order x order matrix
  std::int32_t first_block = 0;

  /// Fewer rows than columns: the Gram matrix is XX', and A = WX.
  bool wide() const { return rows < columns; }
};
static_assert(sizeof(SegmentRecord) == 56);

/// One block of rows of a segment; mirrors block_t of kernels/prelude.cl.
struct BlockRecord {
  std::int32_t segment = 0;
  std::int32_t block = 0;
};

/// Shape of a ragged batch in device memory, and the segments that still take part.
///
/// Stacked matrices have rows() x pitch() reals as in SegmentBatch. Beside them every segment has
/// square matrices of size `order` and vectors of `order` entries, packed one after the other.
class Batch {
 public:
  /// Describes the segments [first, last) of `shape`; all of them active.
  Batch(const Device& device, const SegmentBatch& shape, Index first, Index last);

  Index segments() const { return static_cast<Index>(records_.size()); }
  const SegmentRecord& segment(Index b) const { return records_[static_cast<std::size_t>(b)]; }

  std::size_t stacked_size() const { return stacked_size_; }  ///< reals of a stacked matrix
  std::size_t square_size() const { return square_size_; }    ///< reals of all square matrices
  std::size_t vector_size() const { return vector_size_; }    ///< reals of all vectors
  std::size_t block_count() const { return block_count_; }    ///< blocks of all segments
  std::size_t partial_size() const {
    return partial_size_;
  }                                                     ///< reals of the partial Gram matrices
  bool has_wide() const { return has_wide_; }           ///< any with fewer rows than columns
  int pitch() const { return records_.front().pitch; }  ///< of the stacked matrices
  int largest_order_pitch() const { return largest_order_pitch_; }

  /// Leaves only these segments (increasing indices) in the launches from now on.
  void select(std::span<const std::int32_t> active);

  std::span<const std::int32_t> active() const { return active_; }
  std::int32_t active_count() const { return static_cast<std::int32_t>(active_.size()); }
  std::int32_t active_blocks() const { return active_blocks_; }

  // For kernel arguments.
  const Buffer<SegmentRecord>& device_segments() const { return device_segments_; }
  const Buffer<std::int32_t>& device_active() const { return device_active_; }
  const Buffer<BlockRecord>& device_blocks() const { return device_blocks_; }

 private:
  std::vector<SegmentRecord> records_;
  std::vector<std::int32_t> active_;
  std::size_t stacked_size_ = 0, square_size_ = 0, vector_size_ = 0, block_count_ = 0;
  std::size_t partial_size_ = 0;
  bool has_wide_ = false;
  int largest_order_pitch_ = 0;
  std::int32_t active_blocks_ = 0;
  Buffer<SegmentRecord> device_segments_;
  Buffer<std::int32_t> device_active_;
  Buffer<BlockRecord> device_blocks_;
};

/// Which segments a Gram matrix is wanted of; `wide` permits to leave out the others.
enum class GramOf { all, wide };

/// Launches with one work-item per active segment, and per block of their rows.
Grid per_segment(const Batch& batch);
Grid per_block(const Batch& batch);

/// Launch with one work-item per row of the largest square matrix and active segment.
Grid per_row(const Batch& batch);

/// Number type of the stacked matrices a kernel works on.
enum class NumberType { float64, float32 };

template <class Real>
inline constexpr NumberType number_type = sizeof(Real) == sizeof(double) ? NumberType::float64
                                                                         : NumberType::float32;

/// Numbers in the explicit vectors of our kernels on this device, a power of two up to 8 (16 for
/// float32); reaches them as VW.
int vector_width(const Device& device, NumberType type = NumberType::float64);

/// Throws DeviceError if the device has no double precision, which every solver needs for the
/// eigenproblem whatever the type of its stacked matrices.
void require_double_precision(const Device& device);

/// -D options every kernel of ours needs on this device: REAL, VW, BLOCK_ROWS. Throws as
/// require_double_precision() does.
Defines common_defines(const Device& device, NumberType type = NumberType::float64);

}  // namespace moclean
