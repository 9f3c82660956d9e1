#include "moclean/filter/window.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "filter/signal.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::expect_samples;
using test::nan;
using test::rough_wave;
using test::smoothed;
using testing::ElementsAre;
using testing::NanSensitiveDoubleEq;

TEST(MovingAverage, AgreesWithScipy) {  // scipy.ndimage.uniform_filter1d(y, 7)
  expect_samples(smoothed(MovingAverage{.window = 7}, rough_wave()), {{10, 1.34162876981664},
                                                                      {15, -4.53448038753868},
                                                                      {17, -4.04850101370687},
                                                                      {18, -2.43651576670982},
                                                                      {20, 1.08302116815092},
                                                                      {28, 7.14367739987673}});
}

TEST(MovingAverage, ShrinksAtTheEndsAndBesideGaps) {
  EXPECT_THAT(smoothed(MovingAverage{.window = 3}, {1, 3, 8, nan, 2, 4}),
              ElementsAre(2, 4, 5.5, NanSensitiveDoubleEq(nan), 3, 3));
}

TEST(GaussianFilter, AgreesWithScipy) {  // scipy.ndimage.gaussian_filter1d(y, 2, truncate=4)
  expect_samples(smoothed(GaussianFilter{.sd = 2}, rough_wave()), {{10, 1.09442598114515},
                                                                   {15, -5.14063095945645},
                                                                   {17, -2.51886804773755},
                                                                   {18, -1.77471716127822},
                                                                   {20, -0.619702361410941},
                                                                   {28, 7.36607710654875}});
}

TEST(GaussianFilter, KeepsAConstantAtTheEndsAndBesideGaps) {
  const auto z = smoothed(GaussianFilter{.sd = 3}, {5, 5, nan, 5, nan, nan, 5});

  for (const std::size_t seen : {0, 1, 3, 6}) EXPECT_NEAR(z[seen], 5, test::tolerance::by_hand(5));
  for (const std::size_t gap : {2, 4, 5}) EXPECT_TRUE(std::isnan(z[gap]));
}

TEST(MedianFilter, AgreesWithScipy) {  // scipy.ndimage.median_filter(y, 7)
  expect_samples(smoothed(MedianFilter{.window = 7}, rough_wave()), {{10, 2.21120008059867},
                                                                     {15, -7.32764487555988},
                                                                     {17, -7.32764487555988},
                                                                     {18, -3.59415498198926},
                                                                     {20, 0.968139004843497},
                                                                     {28, 7.3459890808828}});
}

TEST(MedianFilter, ShrinksAtTheEndsAndBesideGaps) {
  EXPECT_THAT(smoothed(MedianFilter{.window = 5}, {9, 1, 4, nan, 2}),
              ElementsAre(4, 4, 3, NanSensitiveDoubleEq(nan), 3));
}

TEST(MedianFilter, RemovesAnErrorShorterThanHalfTheWindow) {
  const auto z = smoothed(MedianFilter{.window = 7}, {1, 1, 1, 1, 90, -90, 50, 1, 1, 1, 1});

  for (const double x : z) EXPECT_EQ(x, 1);
}

// Median, and median absolute deviation from it, of the window around frame i.
std::pair<double, double> by_sorting(const std::vector<double>& y, std::size_t i,
                                     std::size_t reach) {
  std::vector<double> window;
  for (std::size_t j = i < reach ? 0 : i - reach; j <= std::min(y.size() - 1, i + reach); ++j)
    if (!std::isnan(y[j])) window.push_back(y[j]);
  const auto middle = [&] {
    std::ranges::sort(window);
    const std::size_t n = window.size();
    return n % 2 != 0 ? window[n / 2] : (window[n / 2 - 1] + window[n / 2]) / 2;
  };
  const double median = middle();
  for (double& x : window) x = std::abs(x - median);
  return {median, middle()};
}

// With gaps and without, and windows on both sides of what is done in blocks.
TEST(MedianAndHampel, AgreeWithSortingEveryWindow) {
  const Matrix noise = test::random_matrix(1, 300, 1);
  const std::vector<double> whole(noise.data(), noise.data() + 300);
  auto holey = whole;
  for (const std::size_t gap : {0, 17, 18, 19, 20, 21, 22, 23, 120, 299}) holey[gap] = nan;
  for (auto y : {whole, holey})
    for (const Index window : {3, 9, 15, 17}) {
      SCOPED_TRACE(window);
      y[50] = y[51] = y[53];
      const auto medians = smoothed(MedianFilter{.window = window}, y);
      const auto cleaned = smoothed(Hampel{.window = window, .sigmas = 1}, y);
      for (std::size_t i = 0; i < y.size(); ++i) {
        EXPECT_EQ(std::isnan(medians[i]), std::isnan(y[i]));
        EXPECT_EQ(std::isnan(cleaned[i]), std::isnan(y[i]));
        if (std::isnan(y[i])) continue;
        const auto [median, mad] = by_sorting(y, i, static_cast<std::size_t>(window) / 2);
        EXPECT_EQ(medians[i], median) << i;
        EXPECT_EQ(cleaned[i], std::abs(y[i] - median) > 1.4826 * mad ? median : y[i]) << i;
      }
    }
}

// numpy.median and scipy.stats.median_abs_deviation of numpy's sliding_window_view(y, 7); frames 5,
// 14, 17, 26, 27 and 36 of the wave's inside are replaced.
TEST(Hampel, AgreesWithScipy) {
  const auto z = smoothed(Hampel{.window = 7, .sigmas = 1}, rough_wave());

  expect_samples(z, {{10, 2.21120008059867},
                     {15, -9.77530117665097},
                     {16, -8.36164608835841},
                     {17, -7.32764487555988},
                     {18, -7.32764487555988},
                     {24, 9.13667863849153}});
  const auto y = rough_wave();
  std::vector<std::size_t> replaced;
  for (std::size_t i = 3; i < 37; ++i)
    if (z[i] != y[i]) replaced.push_back(i);
  EXPECT_THAT(replaced, ElementsAre(5, 14, 17, 26, 27, 36));
}

TEST(Hampel, ReplacesOnlyWhatIsFarFromTheMedian) {
  // Of 1 2 3 4 50: median 3, deviations 0 1 1 2 47, MAD 1, bound 3 * 1.4826.
  EXPECT_THAT(smoothed(Hampel{.window = 9, .sigmas = 3}, {1, 2, 50, 3, 4}),
              ElementsAre(1, 2, 3, 3, 4));
  EXPECT_THAT(smoothed(Hampel{.window = 9, .sigmas = 3}, {1, 2, 7, 3, nan}),
              ElementsAre(1, 2, 2.5, 3, NanSensitiveDoubleEq(nan)));  // median 2.5, MAD 1
  EXPECT_THAT(smoothed(Hampel{.window = 9, .sigmas = 4}, {1, 2, 7, 3, nan}),
              ElementsAre(1, 2, 7, 3, NanSensitiveDoubleEq(nan)));
}

TEST(Windows, OfOneFrameChangeNothing) {
  EXPECT_EQ(smoothed(MovingAverage{.window = 1}, rough_wave()), rough_wave());
  EXPECT_EQ(smoothed(MedianFilter{.window = 1}, rough_wave()), rough_wave());
  EXPECT_EQ(smoothed(Hampel{.window = 1}, rough_wave()), rough_wave());
}

TEST(Windows, MayBeLongerThanTheChannel) {
  EXPECT_THAT(smoothed(MovingAverage{.window = 99}, {1, 2, 6}), ElementsAre(3, 3, 3));
  EXPECT_THAT(smoothed(MedianFilter{.window = 99}, {1, 2, 6}), ElementsAre(2, 2, 2));
}

TEST(Windows, RefuseParametersOutOfRange) {
  EXPECT_THROW(check(MovingAverage{.window = 2147483647}), ArgumentError);
  EXPECT_THROW(check(MedianFilter{.window = 2147483647}), ArgumentError);
  EXPECT_THROW(check(Hampel{.window = 2147483647}), ArgumentError);
  EXPECT_THROW(check(GaussianFilter{.sd = 1e9}), ArgumentError);
  EXPECT_THROW(check(MovingAverage{.window = 4}), ArgumentError);
  EXPECT_THROW(check(MedianFilter{.window = 0}), ArgumentError);
  EXPECT_THROW(check(Hampel{.window = -1}), ArgumentError);
  EXPECT_THROW(check(Hampel{.sigmas = -1}), ArgumentError);
  EXPECT_THROW(check(GaussianFilter{.sd = 0}), ArgumentError);
  EXPECT_THROW(check(GaussianFilter{.sd = nan}), ArgumentError);
}

}  // namespace
}  // namespace moclean
