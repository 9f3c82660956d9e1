#include "moclean/solve/opencl/batch_plan.hpp"

#include <algorithm>
#include <numeric>

#include <gmock/gmock.h>

namespace moclean::opencl {
namespace {

using ::testing::ElementsAre;

std::vector<SegmentSize> equal_sizes(std::size_t count, std::uint64_t bytes) {
  return std::vector<SegmentSize>(count, {.memory = bytes, .stacked = bytes / 4});
}

std::vector<Index> lengths(const BatchPlan& plan) {
  std::vector<Index> result(plan.first.size());
  std::adjacent_difference(plan.first.begin(), plan.first.end(), result.begin());
  result.erase(result.begin());
  return result;
}

TEST(BatchPlan, WithoutBoundsIsOneBatch) {
  const BatchPlan plan = plan_batches(equal_sizes(100, 10), {});

  EXPECT_THAT(lengths(plan), ElementsAre(100));
  EXPECT_EQ(plan.queues, 1);
}

TEST(BatchPlan, OfNothingHasNoBatch) { EXPECT_EQ(plan_batches({}, {.queues = 2}).batches(), 0); }

TEST(BatchPlan, LanesAreLeftEmptyBeforeQueuesAre) {
  const auto plan_of = [](std::size_t segments, int queues) {
    return plan_batches(equal_sizes(segments, 10), {.queues = queues, .lanes = 8});
  };

  EXPECT_THAT(lengths(plan_of(8, 1)), ElementsAre(8));
  EXPECT_THAT(lengths(plan_of(8, 2)), ElementsAre(4, 4));
  EXPECT_THAT(lengths(plan_of(9, 4)), ElementsAre(2, 2, 2, 3));
  EXPECT_THAT(lengths(plan_of(2, 4)), ElementsAre(1, 1));
  EXPECT_EQ(plan_of(1, 4).queues, 1) << "a second one would have nothing to do";
}

TEST(BatchPlan, QueuesGetEqualShares) {
  const BatchBounds bounds{.queues = 2, .lanes = 8};

  EXPECT_THAT(lengths(plan_batches(equal_sizes(13, 10), bounds)), ElementsAre(6, 7));
  EXPECT_THAT(lengths(plan_batches(equal_sizes(100, 10), bounds)), ElementsAre(50, 50));
  EXPECT_EQ(plan_batches(equal_sizes(13, 10), bounds).queues, 2);
}

// A batch per queue may take 3/8 of the cache, here 120 bytes: 12 segments, one set of lanes.
TEST(BatchPlan, KeepsWhatIsInFlightInTheCache) {
  const BatchBounds bounds{.cache = 320, .queues = 2, .lanes = 8};

  EXPECT_THAT(lengths(plan_batches(equal_sizes(27, 10), bounds)), ElementsAre(6, 7, 7, 7));
  EXPECT_THAT(lengths(plan_batches(equal_sizes(32, 10), bounds)), ElementsAre(8, 8, 8, 8));
  EXPECT_THAT(lengths(plan_batches(equal_sizes(33, 10), bounds)), ElementsAre(5, 6, 5, 6, 5, 6));
}

// 180 bytes per queue: two sets of lanes to a batch.
TEST(BatchPlan, TakesWholeSetsOfLanes) {
  const BatchBounds bounds{.cache = 480, .queues = 2, .lanes = 8};

  EXPECT_THAT(lengths(plan_batches(equal_sizes(64, 10), bounds)), ElementsAre(16, 16, 16, 16));
}

TEST(BatchPlan, RatherFillsTheCacheThanLeavesLanesEmpty) {
  const BatchBounds bounds{.cache = 160, .queues = 2, .lanes = 8};

  EXPECT_THAT(lengths(plan_batches(equal_sizes(16, 10), bounds)), ElementsAre(8, 8));
}

// One queue's share is 80 bytes, three quarters of it 60: 8 segments do not fit, 5 are in comfort.
TEST(BatchPlan, LongSegmentsLeaveLanesEmpty) {
  const BatchBounds bounds{.cache = 160, .queues = 2, .lanes = 8};

  EXPECT_THAT(lengths(plan_batches(equal_sizes(20, 12), bounds)), ElementsAre(5, 5, 5, 5));
  EXPECT_THAT(lengths(plan_batches(equal_sizes(3, 1000), bounds)), ElementsAre(1, 1, 1));
}

TEST(BatchPlan, MemoryIsDividedBetweenTheQueues) {
  const BatchBounds bounds{.memory = 100, .queues = 2, .lanes = 8};

  const BatchPlan plan = plan_batches(equal_sizes(20, 10), bounds);

  EXPECT_THAT(plan.first, ElementsAre(0, 5, 10, 15, 20));
  EXPECT_EQ(plan.queues, 2);
}

TEST(BatchPlan, QueuesWithoutRoomForTheLargestSegmentAreNotUsed) {
  std::vector<SegmentSize> sizes = equal_sizes(6, 10);
  sizes[4].memory = 40;

  const BatchPlan plan = plan_batches(sizes, {.memory = 90, .queues = 3, .lanes = 8});

  EXPECT_EQ(plan.queues, 2);
  EXPECT_EQ(plan.permitted_queues, 2);
  EXPECT_EQ(plan_batches(sizes, {.memory = 79, .queues = 3, .lanes = 8}).permitted_queues, 1);
}

TEST(BatchPlan, AllocationBoundsAStackedMatrix) {
  const BatchPlan plan = plan_batches(equal_sizes(10, 40), {.allocation = 35});

  EXPECT_THAT(lengths(plan), ElementsAre(3, 3, 3, 1));
}

TEST(BatchPlan, WantedNumberOfSegmentsComesBeforeBalance) {
  const BatchPlan plan = plan_batches(equal_sizes(10, 10), {.queues = 2, .segments = 4});

  EXPECT_THAT(lengths(plan), ElementsAre(4, 4, 2));
}

TEST(BatchPlan, OfAnySizesIsCompleteAndWithinTheBounds) {
  std::uint64_t seed = 1;
  const auto random = [&](std::uint64_t most) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return 1 + (seed >> 33) % most;
  };
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<SegmentSize> sizes(random(60));
    for (SegmentSize& size : sizes) size = {.memory = random(100), .stacked = random(20)};
    const BatchBounds bounds{.memory = 100 + random(1000),
                             .allocation = 20 + random(100),
                             .cache = random(1000),
                             .queues = static_cast<int>(random(5)),
                             .lanes = static_cast<Index>(random(8))};

    const BatchPlan plan = plan_batches(sizes, bounds);

    ASSERT_EQ(plan.first.front(), 0);
    ASSERT_EQ(plan.first.back(), static_cast<Index>(sizes.size()));
    ASSERT_GE(plan.queues, 1);
    ASSERT_LE(plan.queues, std::min<Index>(bounds.queues, plan.batches()));
    for (std::size_t i = 0; i + 1 < plan.first.size(); ++i) {
      ASSERT_LT(plan.first[i], plan.first[i + 1]);
      std::uint64_t memory = 0, stacked = 0;
      for (auto b = plan.first[i]; b < plan.first[i + 1]; ++b) {
        memory += sizes[static_cast<std::size_t>(b)].memory;
        stacked += sizes[static_cast<std::size_t>(b)].stacked;
      }
      ASSERT_LE(memory * static_cast<std::uint64_t>(plan.queues), bounds.memory);
      ASSERT_LE(stacked, bounds.allocation);
    }
  }
}

}  // namespace
}  // namespace moclean::opencl
