#include "moclean/filter/butterworth.hpp"

#include <cmath>
#include <numbers>

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
using testing::ThrowsMessage;

// scipy.signal.sosfiltfilt(scipy.signal.butter(order, cutoff, fs=100, output='sos'), y), edges too.
TEST(Butterworth, AgreesWithScipy) {
  expect_samples(smoothed(Butterworth{.cutoff = 10, .order = 4}, rough_wave(), 100),
                 {{0, -2.05803879912571},
                  {1, 1.67922416626524},
                  {8, 6.67689668044433},
                  {15, -6.04930318739431},
                  {17, -3.79955510201332},
                  {20, -0.394387142038366},
                  {30, 4.51233694984016},
                  {38, -9.46686390268223},
                  {39, -8.71639615740638}});
}

TEST(Butterworth, AgreesWithScipyForOddOrders) {
  expect_samples(smoothed(Butterworth{.cutoff = 6, .order = 3}, rough_wave(), 100),
                 {{0, -1.86065146212706},
                  {15, -5.08753013966482},
                  {17, -4.27946314396182},
                  {39, -9.72946043147109}});
  expect_samples(smoothed(Butterworth{.cutoff = 20, .order = 1}, rough_wave(), 100),
                 {{0, -1.9999985901633},
                  {15, -8.4047765890376},
                  {17, 1.6925880972396},
                  {39, -8.81980410438554}});
}

TEST(Butterworth, AgreesWithScipyNearHalfTheFrameRate) {
  expect_samples(smoothed(Butterworth{.cutoff = 45, .order = 2}, rough_wave(), 100),
                 {{0, -2.09620687183664}, {17, 11.6689293123009}, {39, -8.70277359944249}});
}

TEST(Butterworth, PadsAShortRunByWhatItHas) {  // sosfiltfilt(..., y[:6], padlen=5)
  auto y = rough_wave();
  y.resize(6);

  expect_samples(smoothed(Butterworth{.cutoff = 10, .order = 4}, y, 100),
                 {{0, -2.18135268546533}, {2, 4.89565419629777}, {5, 12.1449483906979}});
}

TEST(Butterworth, HalvesASinusoidAtTheCutOff) {
  std::vector<double> y;
  for (int t = 0; t < 1000; ++t) y.push_back(std::sin(2 * std::numbers::pi * 0.05 * t + 0.3));

  const auto z = smoothed(Butterworth{.cutoff = 6, .order = 4}, y, 120);

  for (const std::size_t t : {400, 473, 500})
    EXPECT_NEAR(z[t], y[t] / 2, test::tolerance::scipy());  // no delay either
}

TEST(Butterworth, FiltersEveryRunBetweenGapsByItself) {
  auto y = rough_wave();
  const Butterworth filter{.cutoff = 10, .order = 4};
  const auto left = smoothed(filter, {y.begin(), y.begin() + 12}, 100);
  const auto right = smoothed(filter, {y.begin() + 14, y.end()}, 100);
  y[12] = y[13] = nan;

  const auto z = smoothed(filter, y, 100);

  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(z[i], left[i]);
  EXPECT_TRUE(std::isnan(z[12]) && std::isnan(z[13]));
  for (std::size_t i = 14; i < 40; ++i) EXPECT_EQ(z[i], right[i - 14]);
}

TEST(Butterworth, KeepsAConstantAndASingleSample) {
  for (const double x : smoothed(Butterworth{}, {4, 4, 4, nan, 4}, 120))
    if (!std::isnan(x)) {
      EXPECT_NEAR(x, 4, test::tolerance::sum_of_products(16, 4));
    }
}

TEST(Butterworth, RefusesParametersOutOfRange) {
  EXPECT_THAT(
      [] {
        smoothed(Butterworth{.cutoff = 60}, {1, 2}, 120);
      },
      ThrowsMessage<ArgumentError>(
          "butterworth: cutoff is 60 Hz, expected less than half the frame rate of 120 Hz"));
  EXPECT_THROW(check(Butterworth{.cutoff = 0}), ArgumentError);
  EXPECT_THROW(check(Butterworth{.order = 0}), ArgumentError);
  EXPECT_THROW(check(Butterworth{.order = 13}), ArgumentError);
}

}  // namespace
}  // namespace moclean
