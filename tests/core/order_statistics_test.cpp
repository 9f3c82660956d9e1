#include "moclean/core/order_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "moclean/core/linear_fill.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;

double quantile_of(std::vector<double> values, double q) { return quantile(values, q); }

TEST(Quantile, InterpolatesBetweenTheNearestOrderStatistics) {
  EXPECT_DOUBLE_EQ(quantile_of({4, 1, 3, 2}, 0), 1);
  EXPECT_DOUBLE_EQ(quantile_of({4, 1, 3, 2}, 0.25), 1.75);  // place 0.75 of 0 .. 3
  EXPECT_DOUBLE_EQ(quantile_of({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile_of({4, 1, 3, 2}, 1), 4);
  EXPECT_DOUBLE_EQ(quantile_of({7}, 0.3), 7);
}

// Type 7 as it is defined, by sorting.
double quantile_by_sorting(std::vector<double> values, double q) {
  std::ranges::sort(values);
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double low = values[below], high = values[std::min(below + 1, values.size() - 1)];
  return low + (place - static_cast<double>(below)) * (high - low);
}

TEST(Quantile, OfManyValuesIsThatOfTheSortedOnes) {
  std::mt19937 random(1);
  std::exponential_distribution<double> skewed;
  for (const std::size_t size : {511u, 512u, 2048u, 4096u, 70001u})
    for (int kind = 0; kind < 5; ++kind) {
      std::vector<double> values(size);
      for (std::size_t i = 0; i < size; ++i) {
        const auto x = static_cast<double>(i);
        // Rising, random, almost all equal, few different, and small where a sample would look.
        const double of_kind[] = {
            x, skewed(random), i == 7 ? -1.0 : 3.0, std::fmod(x, 3),
            i % std::max<std::size_t>(1, size / (size < 4096 ? 64 : 512)) == 0 ? -x : x};
        values[i] = of_kind[kind];
      }
      for (const double q : {0.0, 1e-4, 0.25, 0.5, 0.9, 0.9999, 1.0})
        EXPECT_DOUBLE_EQ(quantile_of(values, q), quantile_by_sorting(values, q))
            << size << " values, kind " << kind << ", q " << q;
    }
}

TEST(RunningMedian, ShrinksItsWindowAtBothEnds) {
  std::vector<double> samples = {5, 1, 9, 2, 8};

  running_median(samples, 3);

  EXPECT_THAT(samples, ElementsAre(3, 5, 2, 8, 5));  // ends: means of two
}

TEST(RunningMedian, TakesAWindowLongerThanTheChannel) {
  std::vector<double> samples = {5, 1, 9};

  running_median(samples, 99);

  EXPECT_THAT(samples, ElementsAre(5, 5, 5));
}

std::vector<double> filled(std::vector<double> channel, const std::vector<bool>& seen) {
  Eigen::Array<bool, Eigen::Dynamic, 1> observed(static_cast<Eigen::Index>(seen.size()));
  for (std::size_t i = 0; i < seen.size(); ++i) observed(static_cast<Eigen::Index>(i)) = seen[i];
  fill_linearly(channel, observed);
  return channel;
}

TEST(FillLinearly, DrawsALineBetweenSamplesAndHoldsTheEnds) {
  EXPECT_THAT(filled({0, 2, 0, 0, 8, 0}, {false, true, false, false, true, false}),
              ElementsAre(2, 2, 4, 6, 8, 8));
}

TEST(FillLinearly, LeavesWhatWasObservedAndZeroesWhatNeverWas) {
  EXPECT_THAT(filled({3, 1, 2}, {true, true, true}), ElementsAre(3, 1, 2));
  EXPECT_THAT(filled({3, 1, 2}, {false, false, false}), ElementsAre(0, 0, 0));
}

}  // namespace
}  // namespace moclean
