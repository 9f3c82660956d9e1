#include "moclean/linalg/batch.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace moclean {
namespace {

std::int32_t blocks_of(const SegmentRecord& record) {
  return (record.rows + block_rows - 1) / block_rows;
}

}  // namespace

Batch::Batch(const Device& device, const SegmentBatch& shape, Index first, Index last) {
  const Index origin = shape.first_row(first);
  for (Index b = first; b < last; ++b) {
    SegmentRecord record;
    const Index order = std::min(shape.rows(b), shape.columns());
    const auto order_pitch = static_cast<std::size_t>(padded(order));
    record.first_row = shape.first_row(b) - origin;
    record.square = static_cast<std::int64_t>(square_size_);
    record.vector = static_cast<std::int64_t>(vector_size_);
    record.rows = static_cast<std::int32_t>(shape.rows(b));
    record.columns = static_cast<std::int32_t>(shape.columns());
    record.pitch = static_cast<std::int32_t>(shape.pitch());
    record.order = static_cast<std::int32_t>(order);
    record.order_pitch = static_cast<std::int32_t>(order_pitch);
    record.first_block = static_cast<std::int32_t>(block_count_);
    record.partial = static_cast<std::int64_t>(partial_size_);
    has_wide_ = has_wide_ || record.wide();
    if (!record.wide())
      partial_size_ += static_cast<std::size_t>(blocks_of(record) - 1) *
                       static_cast<std::size_t>(order) * order_pitch;
    square_size_ += static_cast<std::size_t>(order) * order_pitch;
    vector_size_ += order_pitch;
    block_count_ += static_cast<std::size_t>(blocks_of(record));
    largest_order_pitch_ = std::max(largest_order_pitch_, record.order_pitch);
    records_.push_back(record);
  }
  stacked_size_ = static_cast<std::size_t>((shape.first_row(last) - origin) * shape.pitch());
  device_segments_ = Buffer<SegmentRecord>(device, std::span<const SegmentRecord>(records_));
  device_active_ = Buffer<std::int32_t>(device, records_.size());
  device_blocks_ = Buffer<BlockRecord>(device, block_count_);
  std::vector<std::int32_t> all(records_.size());
  std::iota(all.begin(), all.end(), 0);
  select(all);
}

void Batch::select(std::span<const std::int32_t> active) {
  active_.assign(active.begin(), active.end());
  std::vector<BlockRecord> blocks;
  for (const std::int32_t b : active_)
    for (std::int32_t i = 0; i < blocks_of(segment(b)); ++i) blocks.push_back({b, i});
  active_blocks_ = static_cast<std::int32_t>(blocks.size());
  device_active_.write(active_);
  device_blocks_.write(blocks);
}

Grid per_segment(const Batch& batch) {
  return {.x = static_cast<std::size_t>(batch.active_count())};
}

Grid per_block(const Batch& batch) {
  return {.x = static_cast<std::size_t>(batch.active_blocks())};
}

Grid per_row(const Batch& batch) {
  return {.x = static_cast<std::size_t>(batch.largest_order_pitch()), .y = batch.active().size()};
}

int vector_width(const Device& device, NumberType type) {
  // A width of 16 is not a width of doubles anywhere; powers of two only. Where vectors help at
  // all, they hold twice as many floats.
  const int doubles = static_cast<int>(
      std::bit_floor(static_cast<unsigned>(std::clamp(device.info().vector_width, 1, 8))));
  return type == NumberType::float32 && doubles > 1 ? 2 * doubles : doubles;
}

void require_double_precision(const Device& device) {
  if (!device.info().fp64)
    throw DeviceError("device '" + device.info().name +
                      "' has no double precision (cl_khr_fp64), which this solver needs; choose "
                      "another with --device, or --backend reference");
}

Defines common_defines(const Device& device, NumberType type) {
  require_double_precision(device);
  return {{"REAL", type == NumberType::float64 ? "double" : "float"},
          {"VW", std::to_string(vector_width(device, type))},
          {"BLOCK_ROWS", std::to_string(block_rows)}};
}

}  // namespace moclean
