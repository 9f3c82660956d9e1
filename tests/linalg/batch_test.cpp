#include "moclean/linalg/batch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/device.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;

TEST(Batch, PacksSquareMatricesOfTheSmallerSide) {
  const SegmentBatch shape(10, {0, 4, 54});
  const Batch batch(test::device(), shape, 0, 2);

  EXPECT_TRUE(batch.segment(0).wide());
  EXPECT_EQ(batch.segment(0).order, 4);
  EXPECT_EQ(batch.segment(1).order, 10);
  EXPECT_EQ(batch.segment(1).order_pitch, 16);
  EXPECT_EQ(batch.segment(1).square, 4 * 16);
  EXPECT_EQ(batch.segment(1).first_row, 4);
  EXPECT_EQ(batch.square_size(), 4u * 16 + 10 * 16);
  EXPECT_EQ(batch.stacked_size(), 54u * 16);
}

TEST(Batch, CountsBlocksPerSegment) {
  const SegmentBatch shape(10, {0, block_rows, 2 * block_rows + 1});
  const Batch batch(test::device(), shape, 0, 2);

  EXPECT_EQ(batch.segment(1).first_block, 1);
  EXPECT_EQ(batch.block_count(), 3u);
  EXPECT_EQ(batch.active_blocks(), 3);
}

TEST(Batch, PartStartsAtItsOwnRowZero) {
  const SegmentBatch shape(10, {0, 5, 12, 20});
  const Batch batch(test::device(), shape, 1, 3);

  EXPECT_EQ(batch.segments(), 2);
  EXPECT_EQ(batch.segment(0).first_row, 0);
  EXPECT_EQ(batch.segment(1).first_row, 7);
  EXPECT_EQ(batch.stacked_size(), 15u * 16);
}

TEST(Batch, DroppedSegmentsLeaveTheLaunches) {
  constexpr Index rows = block_rows + 8;  // two blocks each
  const SegmentBatch shape(10, {0, rows, 2 * rows, 3 * rows});
  Batch batch(test::device(), shape, 0, 3);

  batch.select(std::vector<std::int32_t>{0, 2});
  std::vector<BlockRecord> blocks(4);
  batch.device_blocks().read(blocks);

  EXPECT_THAT(batch.active(), ElementsAre(0, 2));
  EXPECT_EQ(batch.active_blocks(), 4);
  EXPECT_EQ(blocks[2].segment, 2);
  EXPECT_EQ(blocks[3].block, 1);
}

}  // namespace
}  // namespace moclean
