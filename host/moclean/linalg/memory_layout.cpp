#include "moclean/linalg/memory_layout.hpp"

#include <algorithm>

namespace moclean {

MemoryLayout::MemoryLayout(const Device& device, const Batch& batch)
    : device_(&device),
      pitch_(batch.pitch()),
      rows_(batch.stacked_size() / static_cast<std::size_t>(batch.pitch())),
      stacked_(batch.stacked_size()),
      square_(batch.square_size()),
      vector_(batch.vector_size()),
      partial_(batch.partial_size()),
      blocks_(batch.block_count()),
      segments_(static_cast<std::size_t>(batch.segments())) {}

MemoryLayout::MemoryLayout(Index rows, Index columns) : pitch_(padded(columns)), segments_(1) {
  const Index order = std::min(rows, columns), square = order * padded(order);
  const Index blocks = (rows + block_rows - 1) / block_rows;
  rows_ = static_cast<std::size_t>(rows);
  stacked_ = static_cast<std::size_t>(rows * pitch_);
  square_ = static_cast<std::size_t>(square);
  vector_ = static_cast<std::size_t>(padded(order));
  partial_ = static_cast<std::size_t>(rows < columns ? 0 : (blocks - 1) * square);
  blocks_ = static_cast<std::size_t>(blocks);
  bytes_ = sizeof(SegmentRecord) + sizeof(std::int32_t) + blocks_ * sizeof(BlockRecord);
}

}  // namespace moclean
