#include "moclean/linalg/work.hpp"

#include <algorithm>

namespace moclean {

Work gram_work(const SegmentRecord& segment, std::size_t bytes_per_real) {
  const double order = segment.order, depth = std::max(segment.rows, segment.columns);
  return {.flops = depth * order * (order + 1),
          .bytes = depth * order * static_cast<double>(bytes_per_real) +
                   order * (order + 1) / 2 * sizeof(double)};
}

Work apply_work(const SegmentRecord& segment, std::size_t bytes_per_real) {
  const double order = segment.order, entries = double(segment.rows) * segment.columns;
  return {.flops = 2 * entries * order,
          .bytes = (2 * entries + order * order) * static_cast<double>(bytes_per_real)};
}

Work outer_products_work(const SegmentRecord& segment, int terms, std::size_t bytes_per_real) {
  const double order = segment.order;
  return {.flops = 2 * terms * order * order,
          .bytes = terms == 0 ? 0 : (terms + order) * order * static_cast<double>(bytes_per_real)};
}

}  // namespace moclean
