#include "moclean/filter/gcv_spline.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"

#include "filter/signal.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::nan;
using test::rough_wave;
using test::smoothed;
constexpr double two_pi = 6.283185307179586;

// Figures of GCVSPL (Woltring's Fortran of 1986, MD = 2), whose search for p ends at 1e-4 or so.
void expect_woltring(const std::vector<double>& z,
                     const std::vector<std::pair<std::size_t, double>>& expected) {
  for (const auto& [i, value] : expected) EXPECT_NEAR(z[i], value, 1e-4) << i;
}

std::vector<double> noisy_wave(double sd) {
  Random random(1);
  std::vector<double> y;
  for (int t = 0; t < 300; ++t) y.push_back(5 * std::sin(two_pi * t / 90) + sd * random.normal());
  return y;
}

double rms_from_wave(const std::vector<double>& z) {
  double sum = 0;
  for (std::size_t t = 0; t < z.size(); ++t)
    sum += std::pow(z[t] - 5 * std::sin(two_pi * static_cast<double>(t) / 90), 2);
  return std::sqrt(sum / static_cast<double>(z.size()));
}

TEST(GcvSpline, AgreesWithTheProgramOfWoltring) {
  expect_woltring(smoothed(GcvSpline{.degree = 1}, rough_wave()), {{0, 0.591194737},
                                                                   {1, 2.87115208},
                                                                   {15, -7.14278146},
                                                                   {17, 2.12395332},
                                                                   {38, -8.56596822},
                                                                   {39, -8.68479172}});
  expect_woltring(smoothed(GcvSpline{.degree = 3}, rough_wave()), {{0, -0.180332541},
                                                                   {1, 2.68029077},
                                                                   {15, -6.03295085},
                                                                   {17, -3.10459102},
                                                                   {38, -9.46027816},
                                                                   {39, -9.30715202}});
  expect_woltring(smoothed(GcvSpline{.degree = 5}, rough_wave()), {{0, -1.62827459},
                                                                   {1, 2.6651133},
                                                                   {15, -6.04558176},
                                                                   {17, -4.55034239},
                                                                   {38, -9.70387308},
                                                                   {39, -8.69228321}});
}

TEST(GcvSpline, HasNoKnotsInAGapAndLeavesIt) {  // GCVSPL without the frames 10 to 15
  auto y = rough_wave();
  for (std::size_t i = 10; i < 16; ++i) y[i] = nan;

  const auto z = smoothed(GcvSpline{}, y);

  expect_woltring(
      z,
      {{0, -1.0233569}, {9, 6.16683336}, {16, -1.79266411}, {20, 0.0389883285}, {39, -8.96887365}});
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(std::isnan(z[i]), i >= 10 && i < 16) << i;
}

TEST(GcvSpline, FindsHowMuchToSmooth) {
  for (const double sd : {0.01, 0.1, 1.0}) {
    // 300 samples of a slow sinusoid: few degrees of freedom are left.
    EXPECT_LT(rms_from_wave(smoothed(GcvSpline{}, noisy_wave(sd))), 0.5 * sd) << sd;
  }
}

TEST(GcvSpline, KeepsPolynomialsBelowItsOrder) {
  std::vector<double> parabola;
  for (int t = 0; t < 50; ++t) parabola.push_back(3 - 0.5 * t + 0.02 * t * t);

  const auto z = smoothed(GcvSpline{.degree = 5}, parabola);

  for (std::size_t t = 0; t < 50; ++t) EXPECT_NEAR(z[t], parabola[t], 1e-9);
}

TEST(GcvSpline, ShiftsAndScalesWithTheChannel) {
  const auto y = noisy_wave(0.1), z = smoothed(GcvSpline{}, y);
  auto other = y;
  for (double& x : other) x = 1000 * x + 1e6;

  const auto moved = smoothed(GcvSpline{}, other);

  for (std::size_t t = 0; t < y.size(); ++t) EXPECT_NEAR(moved[t], 1000 * z[t] + 1e6, 1e-4);
}

TEST(GcvSpline, LeavesAChannelOfTooFewSamples) {
  const std::vector<double> five = {1, 5, nan, 2, 8, 1};

  const auto z = smoothed(GcvSpline{.degree = 5}, five);

  for (const std::size_t i : {0, 1, 3, 4, 5}) EXPECT_EQ(z[i], five[i]);
  EXPECT_NE(smoothed(GcvSpline{.degree = 3}, five)[1], 5);
}

TEST(GcvSpline, RefusesOtherDegrees) {
  for (const Index degree : {-1, 0, 2, 4, 7})
    EXPECT_THROW(check(GcvSpline{.degree = degree}), ArgumentError) << degree;
}

}  // namespace
}  // namespace moclean
