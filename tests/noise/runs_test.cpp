#include "moclean/noise/runs.hpp"

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

// First frame of the only run of a mask.
Index begin_of(const Mask& touched) {
  Index first = 0;
  while (!touched.row(first).any()) ++first;
  return first;
}

TEST(Burst, DisplacesOneJointByOneVectorThroughoutARun) {
  Recording walk = test::synthetic_walk(100);
  const Matrix clean = walk.samples;

  const Mask touched = spoil(Burst{.runs = {.count = 1, .length = 20}, .sd = 5}, walk);

  EXPECT_EQ(touched.count(), 20 * 3);
  const Index first = begin_of(touched);
  const Matrix added = walk.samples - clean;
  for (Index c = 0; c < 93; ++c) {
    EXPECT_EQ(touched.col(c).count(), touched(first, c) ? 20 : 0);
    EXPECT_EQ(touched(first, c), touched(first, c / 3 * 3));
    for (Index t = 0; t < 20; ++t)
      EXPECT_NEAR(added(first + t, c), added(first, c), test::tolerance::by_hand(40));
  }
  EXPECT_EQ((added.array() != 0).count(), 60);
}

TEST(Burst, HasTheDeviationAskedFor) {
  Recording still{
      .samples = Matrix::Zero(3, 3 * 500), .columns = default_column_names(3 * 500), .unit = ""};

  spoil(Burst{.runs = {.count = 200, .length = 1}, .sd = 5}, still);

  const auto count = static_cast<double>((still.samples.array() != 0).count());
  EXPECT_GT(count, 500);
  EXPECT_NEAR(still.samples.norm() / std::sqrt(count) / 5, 1,
              test::tolerance::five_standard_errors(1, count));
}

TEST(Drift, GrowsEvenlyToItsVector) {
  Recording walk = test::synthetic_walk(100);
  const Matrix clean = walk.samples;

  const Mask touched = spoil(Drift{.runs = {.count = 1, .length = 40}, .sd = 5}, walk);

  const Index first = begin_of(touched);
  const Matrix added = walk.samples - clean;
  for (Index c = 0; c < 93; ++c)
    for (Index t = 0; t < 40; ++t)
      EXPECT_NEAR(added(first + t, c), added(first + 39, c) * static_cast<double>(t + 1) / 40,
                  test::tolerance::by_hand(60));
  EXPECT_EQ(touched.count(), 40 * 3);
}

TEST(Ramp, RisesStaysAndFallsByThirds) {
  Recording walk = test::synthetic_walk(100);
  const Matrix clean = walk.samples;

  const Mask touched = spoil(Ramp{.runs = {.count = 1, .length = 8}, .sd = 5}, walk);

  const double shares[] = {1 / 3.0, 2 / 3.0, 1, 1, 1, 1, 2 / 3.0, 1 / 3.0};
  const Index first = begin_of(touched);
  const Matrix added = walk.samples - clean;
  EXPECT_EQ((added.array() != 0).count(), 8 * 3);
  EXPECT_EQ(touched.count(), 8 * 3);
  for (Index c = 0; c < 93; ++c)
    for (Index t = 0; t < 8; ++t)
      EXPECT_NEAR(added(first + t, c), added(first + 3, c) * shares[t],
                  test::tolerance::by_hand(60));
}

TEST(Ramp, OfTwoFramesIsABurst) {
  Recording ramp = test::synthetic_walk(50), burst = ramp;

  spoil(Ramp{.runs = {.count = 3, .length = 2}}, ramp);
  spoil(Burst{.runs = {.count = 3, .length = 2}}, burst);

  EXPECT_TRUE(test::same_bits(ramp.samples, burst.samples));
}

TEST(Gap, RemovesWholeJoints) {
  Recording walk = test::synthetic_walk(100);
  walk.samples.col(4).setConstant(nan);
  const Matrix clean = walk.samples;

  const Mask touched = spoil(Gap{.runs = {.fraction = 0.2, .length = 10}}, walk);

  EXPECT_FALSE(touched.col(4).any());
  for (Index i = 0; i < clean.size(); ++i) {
    const bool missing = std::isnan(walk.samples.data()[i]);
    EXPECT_EQ(missing, touched.data()[i] || std::isnan(clean.data()[i]));
    if (!missing) {
      EXPECT_EQ(walk.samples.data()[i], clean.data()[i]);
    }
  }
  for (Index c = 6; c < 93; ++c) EXPECT_EQ(touched(50, c), touched(50, c / 3 * 3));
  // 62 runs of 10 frames, some of which overlap.
  EXPECT_LE(touched.count(), 62 * 10 * 3);
  EXPECT_GT(touched.count(), 62 * 10 * 3 / 2);
}

TEST(Swap, ExchangesTwoJoints) {
  Recording walk = test::synthetic_walk(100);
  const Matrix clean = walk.samples;

  const Mask touched = spoil(Swap{.runs = {.count = 1, .length = 30}}, walk);

  EXPECT_EQ(touched.count(), 30 * 6);
  const Index first = begin_of(touched);
  Index one = 0, two = 90;
  while (!touched(first, one)) ++one;
  while (!touched(first, two)) two -= 3;
  EXPECT_EQ(one % 3, 0);
  EXPECT_NE(one, two);
  EXPECT_TRUE(test::same_bits(Matrix(walk.samples.block(first, one, 30, 3)),
                              Matrix(clean.block(first, two, 30, 3))));
  EXPECT_TRUE(test::same_bits(Matrix(walk.samples.block(first, two, 30, 3)),
                              Matrix(clean.block(first, one, 30, 3))));
}

TEST(Swap, TakesSingleColumnsWhereThereAreNoJoints) {
  Recording clip{.samples = Matrix{{1, 2}, {3, 4}}, .columns = {"a", "b"}, .unit = ""};

  const Mask touched = spoil(Swap{.runs = {.count = 1, .length = 2}}, clip);

  EXPECT_TRUE(touched.all());
  EXPECT_EQ(clip.samples, (Matrix{{2, 1}, {4, 3}}));
}

TEST(Swap, LeavesAloneWhatIsMissingInEither) {
  Recording clip{.samples = Matrix{{1, nan}, {3, 4}}, .columns = {"a", "b"}, .unit = ""};

  const Mask touched = spoil(Swap{.runs = {.count = 1, .length = 2}}, clip);

  EXPECT_EQ(clip.samples(0, 0), 1);
  EXPECT_TRUE(std::isnan(clip.samples(0, 1)));
  EXPECT_FALSE(touched.row(0).any());
  EXPECT_TRUE(touched.row(1).all());
}

TEST(Runs, RefuseWhatDoesNotFit) {
  Recording walk = test::synthetic_walk(50);
  Recording narrow{.samples = Matrix::Zero(50, 1), .columns = {"a"}, .unit = ""};

  EXPECT_THAT([&] { spoil(Gap{.runs = {.count = 1, .length = 51}}, walk); },
              ThrowsMessage<ArgumentError>("gap: length is 51, but the clip has only 50 frames"));
  EXPECT_THAT(
      [&] { spoil(Burst{}, walk); },
      ThrowsMessage<ArgumentError>("burst needs count=RUNS or fraction=SHARE, and not both"));
  EXPECT_THAT([&] { spoil(Drift{.runs = {.count = 1}, .sd = -1}, narrow); },
              ThrowsMessage<ArgumentError>("drift: sd is -1, expected at least 0"));
  EXPECT_THAT([&] { spoil(Ramp{.runs = {.count = 1}, .sd = nan}, walk); },
              ThrowsMessage<ArgumentError>("ramp: sd is nan, expected at least 0"));
  EXPECT_THAT([&] { spoil(Swap{.runs = {.count = 1, .length = 1}}, narrow); },
              ThrowsMessage<ArgumentError>("swap: the clip has only one column"));
  EXPECT_THROW(spoil(Gap{.runs = {.fraction = 1.5}}, walk), ArgumentError);
  EXPECT_THROW(spoil(Gap{.runs = {.count = 1, .length = 0}}, walk), ArgumentError);
}

}  // namespace
}  // namespace moclean
