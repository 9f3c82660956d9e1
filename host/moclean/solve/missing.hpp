#pragma once

#include "moclean/core/segment_batch.hpp"

namespace moclean {

/// Whether any entry of a segment is NaN, that is was not observed.
bool has_missing(const ConstMatrixRef& data);

/// 1 where a matrix was observed, 0 where it is NaN.
Matrix observed_entries(const ConstMatrixRef& data);

/// The observed entries, 0 elsewhere.
Matrix observed_part(const ConstMatrixRef& data);

/// The data with their gaps filled along time, column by column: on the straight line between the
/// observed samples beside a gap, by the nearest one at the ends; 0 in a column without any. What
/// iterative methods start from; the same bits on every backend.
Matrix filled_along_time(const ConstMatrixRef& data);

}  // namespace moclean
