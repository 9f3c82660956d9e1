#include "moclean/noise/motion_like.hpp"

#include <gtest/gtest.h>

#include "support/matrix.hpp"

namespace moclean {
namespace {

TEST(MotionLike, IsTheSameOnEveryCallAndAnotherForAnotherSeed) {
  const SegmentBatch first = motion_like(3, 40, 7), again = motion_like(3, 40, 7);
  const SegmentBatch other = motion_like(3, 40, 7, 2);

  EXPECT_TRUE(test::same_bits(first, again));
  EXPECT_FALSE(test::same_bits(first, other));
}

TEST(MotionLike, HasSegmentsOfTheSizeAskedFor) {
  const SegmentBatch batch = motion_like(3, 40, 7);

  EXPECT_EQ(batch.segments(), 3);
  EXPECT_EQ(batch.rows(2), 40);
  EXPECT_EQ(batch.columns(), 7);
}

// Steps of the sinusoids stay below 1 a frame; an entry of noise adds 1 on average.
TEST(MotionLike, JumpsInAboutAThirdOfTheFrames) {
  const SegmentBatch batch = motion_like(1, 300, 50);
  const Matrix x = batch.segment(0);

  Index touched = 0;  // frames far from the mean of their neighbours, two frames away on each side
  for (Index f = 2; f < 298; ++f)
    touched += (2 * x.row(f) - x.row(f - 2) - x.row(f + 2)).cwiseAbs().maxCoeff() > 5;

  EXPECT_GT(touched, 75);
  EXPECT_LT(touched, 240);
}

}  // namespace
}  // namespace moclean
