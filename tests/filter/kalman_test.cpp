#include "moclean/filter/kalman.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "filter/signal.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::expect_samples;
using test::rough_wave;
using test::smoothed;
using Model = KalmanSmoother::Model;

using test::nan;

// The smoothed states of a linear Gaussian model are its most probable ones: scipy.linalg.lstsq
// over the first state and all pushes w, rows (y - x) / measurement, w / process, and the prior.
TEST(KalmanSmoother, AgreesWithLeastSquaresOverTheWholeChannel) {
  expect_samples(smoothed(KalmanSmoother{.process = 1000, .measurement = 1}, rough_wave(), 100),
                 {{0, 4.45490864147678},
                  {1, 5.09634565253461},
                  {8, 3.80437260039459},
                  {15, -3.19433924798414},
                  {17, -2.40405709011884},
                  {20, 0.469299427294362},
                  {30, 3.06414686519859},
                  {38, -10.1501364322574},
                  {39, -11.5239512927883}});
}

TEST(KalmanSmoother, AgreesWithLeastSquaresForConstantAcceleration) {
  const KalmanSmoother filter{.model = Model::acceleration, .process = 3000, .measurement = 2};

  expect_samples(smoothed(filter, rough_wave(), 100), {{0, -1.79845395741559},
                                                       {1, 2.53869065051335},
                                                       {8, 6.15095414668951},
                                                       {15, -6.09668965771911},
                                                       {17, -4.32798718431519},
                                                       {20, -0.300636601908508},
                                                       {30, 4.24559265546554},
                                                       {38, -9.57562620486884},
                                                       {39, -8.32070416498557}});
}

TEST(KalmanSmoother, JoinsTheSidesOfAGapAndLeavesIt) {
  auto y = rough_wave();
  for (std::size_t i = 10; i < 16; ++i) y[i] = nan;

  const auto z = smoothed(KalmanSmoother{.process = 1000, .measurement = 1}, y, 100);

  expect_samples(z, {{0, 3.50982456887829},
                     {9, 5.87763562835567},
                     {16, 1.17045073116963},
                     {20, 1.8448267336718},
                     {39, -11.4765252845451}});
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(std::isnan(z[i]), i >= 10 && i < 16) << i;
}

TEST(KalmanSmoother, DoesNotDependOnTheUnit) {
  auto millimetres = rough_wave();
  for (double& y : millimetres) y *= 1024;

  const auto z =
      smoothed(KalmanSmoother{.process = 1024 * 1000, .measurement = 1024}, millimetres, 100);

  const auto expected =
      smoothed(KalmanSmoother{.process = 1000, .measurement = 1}, rough_wave(), 100);
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(z[i], 1024 * expected[i]);
}

TEST(KalmanSmoother, NeedsNoUnitWithoutParameters) {
  for (const double unit : {1024.0, 0x1p-400, 0x1p-1000, 0x1p400}) {
    auto other = rough_wave();
    for (double& y : other) y *= unit;

    const auto z = smoothed(KalmanSmoother{}, other, 100);

    const auto expected = smoothed(KalmanSmoother{}, rough_wave(), 100);
    for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(z[i], unit * expected[i]) << unit;
  }
}

// Ratio and measurement as in millimetres: a thousandth of the range.
TEST(KalmanSmoother, IsThatOfAThousandthOfTheRangeWithoutParameters) {
  const auto y = rough_wave();
  const auto [least, most] = std::ranges::minmax(y);
  const double measurement = (most - least) / 1000;

  const auto z = smoothed(KalmanSmoother{}, y, 100);

  const auto expected =
      smoothed(KalmanSmoother{.process = 1000 * measurement, .measurement = measurement}, y, 100);
  for (std::size_t i = 0; i < 40; ++i) EXPECT_NEAR(z[i], expected[i], 1e-9) << i;
}

TEST(KalmanSmoother, KeepsAConstantAndASingleSample) {
  for (const double x : smoothed(KalmanSmoother{}, {nan, 4, 4, nan, 4, 4}, 120))
    if (!std::isnan(x)) {
      EXPECT_NEAR(x, 4, test::tolerance::by_hand(4));
    }
  EXPECT_EQ(smoothed(KalmanSmoother{}, {nan, 4, nan}, 120)[1], 4);
}

TEST(KalmanSmoother, RefusesParametersOutOfRange) {
  EXPECT_THROW(check(KalmanSmoother{.process = 0}), ArgumentError);
  EXPECT_THROW(check(KalmanSmoother{.measurement = nan}), ArgumentError);
  EXPECT_THROW(check(KalmanSmoother{.process = 1e160}), ArgumentError);
  EXPECT_THROW(check(KalmanSmoother{.measurement = 1e-160}), ArgumentError);
}

}  // namespace
}  // namespace moclean
