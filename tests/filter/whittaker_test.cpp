#include "moclean/filter/whittaker.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "filter/signal.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::expect_samples;
using test::nan;
using test::rough_wave;
using test::smoothed;

std::vector<double> with_gap() {
  auto y = rough_wave();
  for (std::size_t i = 10; i < 16; ++i) y[i] = nan;
  return y;
}

// scipy.linalg.solveh_banded of W + lambda D'D, D = numpy.diff(numpy.eye(40), difference, axis=0).
TEST(Whittaker, AgreesWithScipy) {
  expect_samples(smoothed(Whittaker{.lambda = 100, .difference = 2}, rough_wave()),
                 {{0, 4.41180472367553},
                  {1, 5.06600130390631},
                  {15, -3.2365684361445},
                  {17, -2.39836511797762},
                  {38, -10.1344423278359},
                  {39, -11.4948856349859}});
  expect_samples(smoothed(Whittaker{.lambda = 50, .difference = 3}, rough_wave()),
                 {{0, -1.76878625814743},
                  {1, 2.55519069649457},
                  {15, -6.09539093977724},
                  {17, -4.30779033638202},
                  {38, -9.58707836986185},
                  {39, -8.3881241291541}});
  expect_samples(smoothed(Whittaker{.lambda = 5, .difference = 1}, rough_wave()),
                 {{0, 2.93303981758868}, {17, -0.886660652750562}, {39, -8.24608256269253}});
}

TEST(Whittaker, JoinsTheSidesOfAGapAndLeavesIt) {  // the same with weight 0 in frames 10 to 15
  const auto z = smoothed(Whittaker{.lambda = 100, .difference = 2}, with_gap());

  expect_samples(z, {{0, 3.48015953484423},
                     {9, 5.88254900073271},
                     {16, 1.14660142020065},
                     {20, 1.8041490668434}});
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(std::isnan(z[i]), i >= 10 && i < 16) << i;
}

TEST(Whittaker, IgnoresMissingSamplesAtTheEnds) {
  const auto inner = smoothed(Whittaker{}, rough_wave());
  auto y = rough_wave();
  y.insert(y.begin(), 2, nan);
  y.push_back(nan);

  const auto z = smoothed(Whittaker{}, y);

  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(z[i + 2], inner[i]);
  EXPECT_TRUE(std::isnan(z[0]) && std::isnan(z[1]) && std::isnan(z[42]));
}

TEST(Whittaker, KeepsAStraightLineAndTooShortAChannel) {
  for (const double slope : {0.0, -0.75}) {
    std::vector<double> line;
    for (int t = 0; t < 30; ++t) line.push_back(3 + slope * t);
    const auto z = smoothed(Whittaker{.lambda = 1e4}, line);
    for (std::size_t t = 0; t < 30; ++t) EXPECT_NEAR(z[t], line[t], test::tolerance::scipy());
  }
  const std::vector<double> two = {nan, 4, nan, 9};
  const auto z = smoothed(Whittaker{.difference = 2}, two);
  EXPECT_EQ(z[1], 4);
  EXPECT_EQ(z[3], 9);
}

// The iteration of the header written with scipy.linalg.solveh_banded.
TEST(RobustWhittaker, AgreesWithScipy) {
  expect_samples(
      smoothed(RobustWhittaker{.lambda = 10, .delta = 0.01, .iterations = 5}, rough_wave()),
      {{0, 4.7996196379886},
       {8, 4.78136632220568},
       {15, -5.1951925323072},
       {17, -4.67211940074789},
       {30, 3.20849972311934},
       {39, -11.3759871291316}});
  expect_samples(smoothed(RobustWhittaker{.lambda = 10, .delta = 0.01}, rough_wave()),
                 {{0, 5.33104684238728},
                  {8, 5.12553583615604},
                  {15, -5.45600142455288},
                  {17, -4.94322073642612},
                  {30, 3.45763829201061},
                  {39, -12.2717509165453}});
}

// A line with errors of the given size in every tenth frame and beside one of them.
std::vector<double> spoilt_line(double size) {
  std::vector<double> y;
  for (int t = 0; t < 60; ++t) y.push_back(1 + 0.5 * t + (t % 10 == 3 || t == 34 ? size : 0));
  return y;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t t = 0; t < a.size(); ++t) largest = std::max(largest, std::abs(a[t] - b[t]));
  return largest;
}

TEST(RobustWhittaker, IsPulledByGrossErrorsNoMoreThanBySmallOnes) {
  constexpr double delta = 0.01;
  const RobustWhittaker robust{.lambda = 1, .delta = delta, .iterations = 1000};
  const auto line = spoilt_line(0), small = smoothed(robust, spoilt_line(10)),
             gross = smoothed(robust, spoilt_line(1e6));

  EXPECT_LT(largest_difference(gross, small), delta);
  EXPECT_LT(largest_difference(gross, line), 1);
  EXPECT_GT(largest_difference(smoothed(Whittaker{.lambda = 1}, spoilt_line(1e6)), line), 1e5);
}

// Weights of 1 / 1e300 would leave nothing of the samples, and zeros or NaN of the curve.
TEST(RobustWhittaker, StaysNearSamplesOfAnySizeWithAnyDelta) {
  const auto line = spoilt_line(0);
  for (const double size : {1e-120, 1.0, 1e120})
    for (const double delta : {1e-300, 1e300}) {
      auto y = line;
      for (double& sample : y) sample *= size;

      const auto z = smoothed(RobustWhittaker{.lambda = 1e4, .delta = delta}, y);

      for (std::size_t t = 0; t < z.size(); ++t) EXPECT_NEAR(z[t] / size, line[t], 0.01) << size;
    }
}

// By hand: 101 samples 0 to 200, 95 % of them within 5 to 195.
TEST(RobustWhittaker, FollowsTheRangeOfTheChannelUnlessTold) {
  std::vector<double> y;
  for (int t = 0; t <= 100; ++t) y.push_back(2 * t);
  y[50] += 40;
  const auto told = smoothed(RobustWhittaker{.lambda = 1000 / 190.0, .delta = 190 / 1000.0}, y),
             untold = smoothed(RobustWhittaker{}, y);
  EXPECT_LT(largest_difference(told, untold), test::tolerance::scipy());

  for (const double size : {0x1p-1000, 0x1p-10, 0x1p10, 0x1p1000}) {
    auto other = y;
    for (double& sample : other) sample *= size;
    other = smoothed(RobustWhittaker{}, other);
    for (double& sample : other) sample /= size;
    EXPECT_EQ(other, untold) << size;
  }
}

TEST(RobustWhittaker, LeavesGaps) {
  const auto z = smoothed(RobustWhittaker{.lambda = 10}, with_gap());

  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(std::isnan(z[i]), i >= 10 && i < 16) << i;
}

TEST(Whittakers, RefuseParametersOutOfRange) {
  EXPECT_THROW(check(Whittaker{.lambda = 0}), ArgumentError);
  EXPECT_THROW(check(Whittaker{.difference = 4}), ArgumentError);
  EXPECT_THROW(check(RobustWhittaker{.lambda = nan}), ArgumentError);
  EXPECT_THROW(check(RobustWhittaker{.difference = 0}), ArgumentError);
  EXPECT_THROW(check(RobustWhittaker{.delta = 0}), ArgumentError);
  EXPECT_THROW(check(RobustWhittaker{.iterations = 0}), ArgumentError);
  EXPECT_THROW(check(Whittaker{.lambda = 1e16}), ArgumentError);
  EXPECT_THROW(check(RobustWhittaker{.lambda = 1e16}), ArgumentError);
}

}  // namespace
}  // namespace moclean
