#include "moclean/solve/backend.hpp"

#include <cmath>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {

void require_finite(const SegmentBatch& data) {
  for (Index b = 0; b < data.segments(); ++b) {
    const ConstMatrixView segment = data.segment(b);
    for (Index i = 0; i < segment.rows(); ++i)
      for (Index j = 0; j < segment.cols(); ++j) {
        const double entry = segment(i, j);
        if (std::abs(entry) <= largest_entry) continue;
        if (std::isfinite(entry))
          throw ShapeError(fmt::format(
              "segment {}: {} at row {}, column {} is too large (at most {} in magnitude)", b,
              entry, i, j, largest_entry));
        throw ShapeError(
            fmt::format("segment {}: not finite at row {}, column {} "
                        "(missing samples are not supported by this method)",
                        b, i, j));
      }
  }
}

}  // namespace moclean
