#include "moclean/core/segment_batch.hpp"

#include <gtest/gtest.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

TEST(SegmentBatch, PadsColumnsToWholeVectors) {
  EXPECT_EQ(padded(1), 16);
  EXPECT_EQ(padded(16), 16);
  EXPECT_EQ(padded(93), 96);
}

TEST(SegmentBatch, StacksSegmentsInOneMatrix) {
  SegmentBatch batch(3, {0, 2, 5});

  batch.segment(1)(0, 2) = 7;

  EXPECT_EQ(batch.segments(), 2);
  EXPECT_EQ(batch.rows(1), 3);
  EXPECT_EQ(batch.storage()[static_cast<std::size_t>(2 * padded(3) + 2)], 7);
}

TEST(SegmentBatch, StartsAllZeroIncludingPadding) {
  const SegmentBatch batch(93, {0, 4});

  for (const double value : batch.storage()) EXPECT_EQ(value, 0);
}

TEST(SegmentBatch, RejectsEmptySegmentsAndMissingColumns) {
  EXPECT_THROW(SegmentBatch(3, {0, 2, 2}), ShapeError);
  EXPECT_THROW(SegmentBatch(3, {1, 2}), ShapeError);
  EXPECT_THROW(SegmentBatch(0, {0, 2}), ShapeError);
}

}  // namespace
}  // namespace moclean
