#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "moclean/core/segment_batch.hpp"

namespace moclean::opencl {

/// The storage of the segments [first, last) of a batch, padding included.
template <class Values>
Values rows_between(auto& batch, Index first, Index last) {
  const auto pitch = static_cast<std::size_t>(batch.pitch());
  const auto begin = static_cast<std::size_t>(batch.first_row(first)) * pitch;
  const auto end = static_cast<std::size_t>(batch.first_row(last)) * pitch;
  return batch.storage().subspan(begin, end - begin);
}

inline std::span<const double> stacked_rows(const SegmentBatch& batch, Index first, Index last) {
  return rows_between<std::span<const double>>(batch, first, last);
}

inline std::span<double> stacked_rows(SegmentBatch& batch, Index first, Index last) {
  return rows_between<std::span<double>>(batch, first, last);
}

/// The segments [first, last) of a batch as one of their own.
inline SegmentBatch segments_between(const SegmentBatch& batch, Index first, Index last) {
  std::vector<Index> first_rows;
  for (Index b = first; b <= last; ++b)
    first_rows.push_back(batch.first_row(b) - batch.first_row(first));
  SegmentBatch part(batch.columns(), std::move(first_rows));
  std::ranges::copy(stacked_rows(batch, first, last), part.storage().begin());
  return part;
}

}  // namespace moclean::opencl
