#include "moclean/noise/background.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "noise/spoil.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;
using test::spoil;
using testing::ThrowsMessage;

Recording still(Index frames, Index columns, double rate = 120, std::string unit = "") {
  return {.samples = Matrix::Zero(frames, columns),
          .columns = default_column_names(columns),
          .frame_rate = rate,
          .unit = std::move(unit)};
}

template <class Noise>
void expect_refused(const Noise& noise, Recording clip, const std::string& message) {
  EXPECT_THAT([&] { spoil(noise, clip); }, ThrowsMessage<ArgumentError>(message));
}

double deviation(const ConstMatrixRef& x) {
  return x.norm() / std::sqrt(static_cast<double>(x.size()));
}

TEST(Jitter, HasTheDeviationAskedForFromTheFirstFrameOn) {
  constexpr Index columns = 6000;
  for (const double cutoff : {0.5, 6.0, 55.0}) {
    Recording clip = still(20, columns);

    spoil(Jitter{.sd = 3.0, .cutoff = cutoff}, clip);

    for (const Index f : {0, 1, 2, 19})
      EXPECT_NEAR(deviation(clip.samples.row(f)) / 3, 1,
                  test::tolerance::five_standard_errors(1 / std::sqrt(2.0), columns))
          << cutoff << " Hz, frame " << f;
  }
}

// A low-pass at a quarter of the rate: y_t = b (x_t + 2 x_{t-1} + x_{t-2}) - a y_{t-2} with
// a = (2 - sqrt 2) / (2 + sqrt 2). Its impulse response gives the correlation of neighbours by
// hand.
TEST(Jitter, HasTheCorrelationOfTheLowPass) {
  constexpr Index columns = 6000;
  Recording clip = still(8, columns, 40);

  spoil(Jitter{.sd = 1.0, .cutoff = 10.0}, clip);

  const double expected = 2 - std::sqrt(2.0);
  for (const Index f : {0, 6}) {
    const double found = clip.samples.row(f).dot(clip.samples.row(f + 1)) /
                         (clip.samples.row(f).norm() * clip.samples.row(f + 1).norm());
    EXPECT_NEAR(found, expected,
                test::tolerance::five_standard_errors(1 - expected * expected, columns));
  }
}

TEST(Jitter, LeavesColumnsIndependent) {
  constexpr Index frames = 20000;
  Recording clip = still(frames, 2, 40);

  spoil(Jitter{.sd = 1.0, .cutoff = 10.0}, clip);

  // Effective number of samples: frames over the sum of squared correlations, below 2 here.
  EXPECT_NEAR(clip.samples.col(0).dot(clip.samples.col(1)) / static_cast<double>(frames), 0,
              test::tolerance::five_standard_errors(1, static_cast<double>(frames) / 2));
}

// Printed once by this code and kept: a platform on which they differ breaks reproducibility.
TEST(Jitter, IsTheSameBitsEverywhere) {
  Recording clip = still(2, 2, 60);

  spoil(Jitter{.sd = 0.5, .cutoff = 3.0}, clip, 2026);

  const Matrix expected{{-0x1.50b6983d9e3efp-1, -0x1.187a9dbf48f85p-1},
                        {-0x1.e21633e12085bp-2, -0x1.c0434e5aacd4cp-2}};
  EXPECT_TRUE(test::same_bits(clip.samples, expected)) << clip.samples;
}

TEST(Jitter, NeedsARateAndACutoffBelowHalfOfIt) {
  expect_refused(Jitter{.sd = 1.0, .cutoff = 6.0}, still(5, 3, 0),
                 "jitter: the cutoff of 6 Hz needs a frame rate, and the recording states none; "
                 "give its rate");
  expect_refused(Jitter{.sd = 1.0, .cutoff = 30.0}, still(5, 3, 60),
                 "jitter: cutoff is 30 Hz, expected at least 0.006 and less than half the frame "
                 "rate of 60 Hz");
  expect_refused(Jitter{.sd = 1.0}, still(5, 3), "jitter needs cutoff=NUMBER");
  expect_refused(Jitter{.cutoff = 6.0}, still(5, 3), "jitter needs sd=NUMBER");
  expect_refused(Jitter{.sd = -1.0, .cutoff = 6.0}, still(5, 3),
                 "jitter: sd is -1, expected at least 0");
  expect_refused(Jitter{.sd = 1.0, .cutoff = 0.0}, still(5, 3),
                 "jitter: cutoff is 0, expected a positive number");
}

TEST(Round, TakesTheNearestMultiple) {
  Recording clip{.samples = Matrix{{0.24, 0.25, -0.74, -0.75, nan, -0.1, 7}},
                 .columns = default_column_names(7),
                 .unit = ""};

  const Mask touched = spoil(Round{.step = 0.5}, clip);

  EXPECT_TRUE(test::same_bits(clip.samples, Matrix{{0, 0.5, -0.5, -1, nan, 0, 7}})) << clip.samples;
  EXPECT_FALSE(touched(0, 4));
  EXPECT_EQ(touched.count(), 6);
}

TEST(Round, NeedsAStep) {
  expect_refused(Round{}, still(5, 3), "round needs step=NUMBER");
  expect_refused(Round{.step = 0.0}, still(5, 3), "round: step is 0, expected a positive number");
}

TEST(White, HasTheDeviationInMillimetresWhateverTheUnit) {
  struct Unit {
    const char* name;
    double millimetres;
  };
  for (const Unit& unit :
       {Unit{"mm", 1}, Unit{"cm", 10}, Unit{"m", 1000}, Unit{"ASF units", 508 / 9.0}}) {
    Recording clip = still(100, 60, 0, unit.name);

    const Mask touched = spoil(White{.sd_mm = 3.0}, clip);

    EXPECT_TRUE(touched.all());
    EXPECT_NEAR(deviation(clip.samples) * unit.millimetres / 3, 1,
                test::tolerance::five_standard_errors(1 / std::sqrt(2.0), 6000))
        << unit.name;
  }
}

TEST(White, TakesTheUnitThatIsGiven) {
  Recording given = still(10, 3, 0, "mm"), known = still(10, 3, 0, "cm");

  spoil(White{.sd_mm = 2.0, .unit_mm = 10.0}, given);
  spoil(White{.sd_mm = 2.0}, known);

  EXPECT_TRUE(test::same_bits(given.samples, known.samples));
}

TEST(White, RefusesAnUnknownUnit) {
  expect_refused(White{.sd_mm = 1.0}, still(5, 3),
                 "white: the recording states no unit; say how many millimetres it is with "
                 "unit-mm=");
  expect_refused(White{.sd_mm = 1.0}, still(5, 3, 0, "inch"),
                 "white: the unit 'inch' is unknown, expected mm, cm, m or ASF units; say how many "
                 "millimetres it is with unit-mm=");
  expect_refused(White{}, still(5, 3), "white needs sd-mm=NUMBER");
  expect_refused(White{.sd_mm = 1.0, .unit_mm = 0.0}, still(5, 3),
                 "white: unit-mm is 0, expected a positive number");
}

template <class Noise>
class Background : public testing::Test {};

struct SlowJitter : Jitter {
  SlowJitter() : Jitter{.sd = 1.0, .cutoff = 6.0} {}
};
struct MillimetreOfNoise : White {
  MillimetreOfNoise() : White{.sd_mm = 1.0, .unit_mm = 1.0} {}
};
using Backgrounds = testing::Types<SlowJitter, MillimetreOfNoise>;
TYPED_TEST_SUITE(Background, Backgrounds);

TYPED_TEST(Background, LeavesMissingSamplesAloneAndDrawsForThem) {
  Recording gappy = still(6, 3), whole = still(6, 3);
  gappy.samples.col(0).setConstant(nan);

  const Mask touched = spoil(TypeParam(), gappy);
  spoil(TypeParam(), whole);

  EXPECT_TRUE(gappy.samples.col(0).array().isNaN().all());
  EXPECT_TRUE(
      test::same_bits(Matrix(gappy.samples.rightCols(2)), Matrix(whole.samples.rightCols(2))));
  EXPECT_FALSE(touched.col(0).any());
  EXPECT_EQ(touched.count(), 12);
}

}  // namespace
}  // namespace moclean
