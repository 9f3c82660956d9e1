#pragma once

#include <span>

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

}  // namespace moclean::opencl
