#include "moclean/core/order_statistics.hpp"

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
