#pragma once

#include <vector>

#include "moclean/linalg/batch.hpp"

namespace moclean {

/// The work of a launch: the sum over the active segments of what `work_of_segment(b, segment)`
/// says.
template <class WorkOfSegment>
Work total_work(const Batch& batch, const WorkOfSegment& work_of_segment) {
  Work total;
  for (const std::int32_t b : batch.active())
    total += work_of_segment(static_cast<std::size_t>(b), batch.segment(b));
  return total;
}

/// A copy of device memory, after everything enqueued before. For counts that only the device has.
template <class T>
std::vector<T> host_copy(const Buffer<T>& buffer) {
  std::vector<T> values(buffer.size());
  buffer.read(values);
  return values;
}

/// One triangle of X'X, or of XX' for a wide segment.
Work gram_work(const SegmentRecord& segment, std::size_t bytes_per_real = sizeof(double));

/// A product of X with a square matrix from one side.
Work apply_work(const SegmentRecord& segment, std::size_t bytes_per_real = sizeof(double));

/// W = sum of `terms` weighted outer products.
Work outer_products_work(const SegmentRecord& segment, int terms,
                         std::size_t bytes_per_real = sizeof(double));

}  // namespace moclean
