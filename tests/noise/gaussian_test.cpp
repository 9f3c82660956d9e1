#include "moclean/noise/gaussian.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "noise/spoil.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;
using test::spoil;
using testing::ThrowsMessage;

TEST(DeviationOf, IsTheMotionAboutItsMeanOverTheRatio) {
  const Matrix samples{{101, 0}, {103, nan}};  // variance 1 of two entries, 0 of one

  EXPECT_NEAR(deviation_of(0, samples), std::sqrt(2 / 3.0), test::tolerance::by_hand(1));
  // The ratio is rounded to single precision.
  EXPECT_NEAR(deviation_of(20, samples), 0.1 * std::sqrt(2 / 3.0),
              test::tolerance::single_rounding());
  EXPECT_EQ(deviation_of(0, Matrix{{nan, nan}}), 0);
}

TEST(DeviationOf, DoesNotDependOnTheOrigin) {
  const Recording walk = test::synthetic_walk(100);

  EXPECT_NEAR(deviation_of(10, walk.samples), deviation_of(10, walk.samples.array() + 64),
              test::tolerance::sum_of_products(100, 1));
}

TEST(Gaussian, TouchesEveryObservedEntry) {
  Recording walk = test::synthetic_walk(40);
  walk.samples(3, 7) = nan;
  const Matrix clean = walk.samples;

  const Mask touched = spoil(Gaussian{.sd = 0.5}, walk);

  EXPECT_FALSE(touched(3, 7));
  EXPECT_TRUE(std::isnan(walk.samples(3, 7)));
  EXPECT_EQ(touched.count(), touched.size() - 1);
  EXPECT_EQ((walk.samples.array() != clean.array()).count(), touched.size());  // NaN != NaN
}

TEST(Gaussian, HasTheDeviationAskedFor) {
  Recording walk = test::synthetic_walk(2000);
  const Matrix clean = walk.samples;

  spoil(Gaussian{.snr = 20}, walk);

  const double asked = deviation_of(20, clean);
  const auto count = static_cast<double>(clean.size());
  const double found = (walk.samples - clean).norm() / std::sqrt(count);
  EXPECT_NEAR(found / asked, 1, test::tolerance::five_standard_errors(1 / std::sqrt(2.0), count));
}

TEST(Gaussian, NeedsExactlyOneOfItsParameters) {
  Recording walk = test::synthetic_walk(4);

  for (const Gaussian& noise : {Gaussian{}, Gaussian{.sd = 1.0, .snr = 1.0}})
    EXPECT_THAT(
        [&] { spoil(noise, walk); },
        ThrowsMessage<ArgumentError>("gaussian needs sd=DEVIATION or snr=DECIBEL, and not both"));
  EXPECT_THROW(spoil(Gaussian{.sd = -1.0}, walk), ArgumentError);
  EXPECT_THROW(spoil(Gaussian{.snr = nan}, walk), ArgumentError);
}

TEST(Dropout, DropsThatShareOfWholeJointsInEveryFrame) {
  Recording walk = test::synthetic_walk(50);
  const Matrix clean = walk.samples;

  const Mask touched =
      spoil(Dropout{.fraction = 0.3, .background = Dropout::Background::none}, walk);

  for (Index f = 0; f < 50; ++f) {
    EXPECT_EQ(touched.row(f).count(), 3 * 9) << f;  // 0.3 of 31 joints
    for (Index c = 0; c < 93; ++c) {
      EXPECT_EQ(touched(f, c), touched(f, c / 3 * 3));
      EXPECT_EQ(walk.samples(f, c), touched(f, c) ? 0 : clean(f, c));
    }
  }
  EXPECT_GT((touched.row(0) != touched.row(1)).count(), 0);
}

TEST(Dropout, AddsABackgroundThatCountsAsUntouched) {
  Recording walk = test::synthetic_walk(50);
  const Matrix clean = walk.samples;

  const Mask touched = spoil(Dropout{.fraction = 0.1, .fill = Dropout::Fill::nan}, walk);

  EXPECT_EQ(touched.count(), 50 * 3 * 3);
  EXPECT_TRUE((walk.samples.array().isNaN() == touched).all());
  EXPECT_TRUE((touched || walk.samples.array() != clean.array()).all());
}

TEST(Dropout, LeavesWhatWasMissingMissingAndUntouched) {
  Recording walk = test::synthetic_walk(5);
  walk.samples.col(0).setConstant(nan);

  const Mask touched = spoil(Dropout{.fraction = 1}, walk);

  EXPECT_TRUE(walk.samples.col(0).array().isNaN().all());
  EXPECT_FALSE(touched.col(0).any());
  EXPECT_TRUE(touched.rightCols(92).all());
  EXPECT_EQ(walk.samples.rightCols(92).norm(), 0);
}

TEST(Dropout, RefusesParametersOutOfRange) {
  Recording walk = test::synthetic_walk(4);

  EXPECT_THROW(spoil(Dropout{.fraction = 1.1}, walk), ArgumentError);
  EXPECT_THROW(spoil(Dropout{.snr = 1e9}, walk), ArgumentError);
}

}  // namespace
}  // namespace moclean
