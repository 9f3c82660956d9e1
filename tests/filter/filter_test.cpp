#include "moclean/filter/filter.hpp"

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean {
namespace {

using test::nan;
using testing::ThrowsMessage;

// One of each kind.
std::vector<Filter> every_filter() {
  return {MovingAverage{}, GaussianFilter{}, MedianFilter{}, Hampel{},
          Butterworth{},   SavitzkyGolay{},  Whittaker{},    RobustWhittaker{},
          GcvSpline{},     KalmanSmoother{}, Interpolate{},  NoFilter{}};
}

// What a filter does not know: gaps, or the column without a sample.
Mask left_missing(const Recording& clip, const Filter& filter) {
  Mask missing = clip.samples.array().isNaN();
  for (Index c = 0; c < missing.cols(); ++c)
    if (fills_gaps(filter) && !missing.col(c).all()) missing.col(c).setConstant(false);
  return missing;
}

TEST(Filtered, CoversEveryFilter) {
  ASSERT_EQ(every_filter().size(), std::variant_size_v<Filter>);
  for (std::size_t i = 0; i < every_filter().size(); ++i) EXPECT_EQ(every_filter()[i].index(), i);
}

TEST(Filtered, KeepsGapsOrFillsThemAndTreatsEveryColumnAlike) {
  Recording walk = test::synthetic_walk(60);
  walk.samples.col(5) = walk.samples.col(4);
  walk.samples.block(20, 7, 12, 1).setConstant(nan);
  walk.samples.col(9).setConstant(nan);
  for (const Filter& filter : every_filter()) {
    SCOPED_TRACE(name_of(filter));

    const Matrix result = filtered(walk, filter);

    EXPECT_TRUE((result.array().isNaN() == left_missing(walk, filter)).all());
    EXPECT_TRUE(test::same_bits(Matrix(result.col(5)), Matrix(result.col(4))));
  }
}

TEST(Filtered, NoFilterChangesNothing) {
  Recording walk = test::synthetic_walk(60);
  walk.samples(7, 3) = nan;
  walk.samples(8, 3) = 1e9;

  EXPECT_TRUE(test::same_bits(filtered(walk, NoFilter{}), walk.samples));
}

TEST(Filtered, OnlyInterpolateFillsGaps) {
  for (const Filter& filter : every_filter())
    EXPECT_EQ(fills_gaps(filter), std::holds_alternative<Interpolate>(filter)) << name_of(filter);
}

TEST(Filtered, DoesNotDependOnTheNumberOfThreads) {
  const Recording walk = test::synthetic_walk(80);
  for (const Filter& filter : every_filter())
    EXPECT_TRUE(test::same_bits(filtered(walk, filter, 1), filtered(walk, filter, 5)))
        << name_of(filter);
}

TEST(Filtered, TakesTheFrameRateFromTheClip) {
  Recording slow = test::synthetic_walk(80), fast = slow;
  fast.frame_rate = 240;

  for (const Filter& filter : every_filter())
    EXPECT_EQ(test::same_bits(filtered(slow, filter), filtered(fast, filter)),
              !needs_frame_rate(filter))
        << name_of(filter);
}

TEST(Filtered, RefusesAClipWithoutTheFrameRateItNeeds) {
  Recording walk = test::synthetic_walk(8);
  walk.frame_rate = 0;

  EXPECT_THAT([&] { filtered(walk, Butterworth{}); },
              ThrowsMessage<ArgumentError>(
                  "butterworth needs the frame rate, which the recording does not state"));
  EXPECT_THROW(filtered(walk, KalmanSmoother{}), ArgumentError);
  EXPECT_NO_THROW(filtered(walk, MedianFilter{}));
}

TEST(Filtered, RefusesParametersOutOfRangeOnAnyThread) {
  const Recording walk = test::synthetic_walk(8);

  EXPECT_THROW(filtered(walk, MedianFilter{.window = 2}, 4), ArgumentError);
  EXPECT_THROW(filtered(walk, Butterworth{.cutoff = 70}, 4), ArgumentError);
}

TEST(Filters, AreWrittenWithEveryParameter) {
  EXPECT_EQ(to_string(Filter(Hampel{.window = 7, .sigmas = 3})), "hampel:window=7,sigmas=3");
  EXPECT_EQ(to_string(Filter(KalmanSmoother{.model = KalmanSmoother::Model::acceleration})),
            "kalman:model=acceleration");
  EXPECT_EQ(to_string(Filter(KalmanSmoother{.process = 1e4})),
            "kalman:model=velocity,process=10000");
}

}  // namespace
}  // namespace moclean
