#include "moclean/filter/savitzky_golay.hpp"

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

// scipy.signal.savgol_filter(y, window, order), edges too: its default mode is "interp".
TEST(SavitzkyGolay, AgreesWithScipy) {
  expect_samples(smoothed(SavitzkyGolay{.window = 11, .order = 3}, rough_wave()),
                 {{0, -1.75159563255698},
                  {1, 2.39420161871637},
                  {8, 6.861840012361},
                  {15, -5.53839699311312},
                  {17, -3.40562635769988},
                  {20, -0.0144865934342051},
                  {30, 4.28656287431021},
                  {38, -9.43450446328921},
                  {39, -7.76112544228265}});
  expect_samples(smoothed(SavitzkyGolay{.window = 5, .order = 2}, rough_wave()),
                 {{0, -1.79278938584823},
                  {1, 2.51921097007617},
                  {17, 2.82247092128995},
                  {38, -9.36882649368586},
                  {39, -7.93319891355505}});
}

TEST(SavitzkyGolay, FitsOnePolynomialToAShortRun) {  // numpy.polyfit(t[:6], y[:6], 3)
  auto y = rough_wave();
  y.resize(6);

  expect_samples(smoothed(SavitzkyGolay{.window = 11, .order = 3}, y),
                 {{0, -2.10853404446314}, {2, 5.79181536007138}, {5, 11.6758011428156}});
}

TEST(SavitzkyGolay, KeepsAPolynomialOfItsOrderOnBothSidesOfAGap) {
  std::vector<double> y;
  for (int t = 0; t < 40; ++t) y.push_back(1 + t - 0.25 * t * t + 0.004 * t * t * t);
  y[20] = nan;

  const auto z = smoothed(SavitzkyGolay{.window = 9, .order = 3}, y);

  EXPECT_TRUE(std::isnan(z[20]));
  for (std::size_t i = 0; i < 40; ++i)
    if (i != 20) {
      EXPECT_NEAR(z[i], y[i], test::tolerance::scipy());
    }
}

TEST(SavitzkyGolay, LeavesRunsItsPolynomialGoesThrough) {
  const auto z = smoothed(SavitzkyGolay{.window = 9, .order = 3}, {7, nan, 1, 5, nan, 2, 8, 3});

  const std::vector<double> expected = {7, nan, 1, 5, nan, 2, 8, 3};
  for (std::size_t i = 0; i < z.size(); ++i)
    if (!std::isnan(expected[i])) {
      EXPECT_NEAR(z[i], expected[i], test::tolerance::by_hand(40));
    }
}

TEST(SavitzkyGolay, RefusesParametersOutOfRange) {
  EXPECT_THROW(check(SavitzkyGolay{.window = 10}), ArgumentError);
  EXPECT_THROW(check(SavitzkyGolay{.window = 1001}), ArgumentError);
  EXPECT_THROW(check(SavitzkyGolay{.window = 3, .order = 3}), ArgumentError);
  EXPECT_THROW(check(SavitzkyGolay{.window = 99, .order = 13}), ArgumentError);
}

}  // namespace
}  // namespace moclean
