#include "moclean/linalg/memory_layout.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/device.hpp"

namespace moclean {
namespace {

struct Everything {
  explicit Everything(MemoryLayout& of)
      : stacked(of.stacked()),
        bands(of.stacked<float>(Initially::undefined, 3)),
        square(of.square()),
        vector(of.vector(Initially::zero)),
        partial(of.partial_grams()),
        rows(of.per_row(2)),
        blocks(of.per_block()),
        chunks(of.chunks(4)),
        sums(of.per_vector_of_columns(8)),
        flags(of.per_segment<std::int32_t>()) {}

  Buffer<double> stacked;
  Buffer<float> bands;
  Buffer<double> square, vector, partial, rows, blocks, chunks, sums;
  Buffer<std::int32_t> flags;
};

TEST(MemoryLayout, MakesBuffersOfTheBatchsSizes) {
  const SegmentBatch shape(10, {0, 4, 54});  // pitch 16; one wide segment, one tall
  const Batch batch(test::device(), shape, 0, 2);
  MemoryLayout layout(test::device(), batch);

  const Everything memory(layout);

  EXPECT_EQ(memory.stacked.size(), 54u * 16);
  EXPECT_EQ(memory.bands.size(), 3u * 54 * 16);
  EXPECT_EQ(memory.square.size(), 4u * 16 + 10 * 16);
  EXPECT_EQ(memory.vector.size(), 2u * 16);
  EXPECT_EQ(memory.partial.size(), 0u);
  EXPECT_EQ(memory.rows.size(), 2u * 54);
  EXPECT_EQ(memory.blocks.size(), 2u);
  EXPECT_EQ(memory.chunks.size(), 2u * 4 * 16);
  EXPECT_EQ(memory.sums.size(), 2u * 2);
  EXPECT_EQ(memory.flags.size(), 2u);
}

TEST(MemoryLayout, ZeroesWhatIsToBeZero) {
  const Batch batch(test::device(), SegmentBatch(3, {0, 2}), 0, 1);
  MemoryLayout layout(test::device(), batch);

  const Everything memory(layout);

  std::vector<double> values(memory.vector.size(), 1);
  memory.vector.read(values);
  EXPECT_THAT(values, testing::Each(0));
}

TEST(MemoryLayout, CountsOfSegmentsAddUpToTheBytesOfTheirBatch) {
  const SegmentBatch shape(10, {0, 4, 54, 54 + 2 * block_rows + 1});
  const Batch batch(test::device(), shape, 0, 3);
  MemoryLayout layout(test::device(), batch);

  const Everything memory(layout);

  std::uint64_t counted = 0;
  for (Index b = 0; b < 3; ++b) counted += memory_of<Everything>(shape.rows(b), 10);
  const std::uint64_t of_batch =
      3 * (sizeof(SegmentRecord) + sizeof(std::int32_t)) + 5 * sizeof(BlockRecord);
  EXPECT_EQ(counted, layout.bytes() + of_batch);
}

}  // namespace
}  // namespace moclean
