#pragma once

#include "moclean/core/segment_batch.hpp"
#include "moclean/device/buffer.hpp"

#include "support/device.hpp"

namespace moclean::test {

/// Stacked matrices on the device.
inline Buffer<double> upload(const SegmentBatch& rows) {
  return Buffer<double>(device(), rows.storage());
}

/// What became of them, of the shape of `like`.
inline SegmentBatch download(const Buffer<double>& buffer, const SegmentBatch& like) {
  SegmentBatch rows(like.columns(), like.first_rows());
  buffer.read(rows.storage());
  return rows;
}

}  // namespace moclean::test
