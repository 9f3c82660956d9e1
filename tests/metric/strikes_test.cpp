#include "moclean/metric/strikes.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "moclean/core/error.hpp"

#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

Recording joints_of(const Matrix& samples, double rate) {
  return {.samples = samples,
          .columns = default_column_names(samples.cols()),
          .frame_rate = rate,
          .unit = ""};
}

// One joint at rest but for spikes (3, 4, 0) of the given sizes: second differences -2, 1, 1 times.
Recording spikes(Index frames, const std::vector<std::pair<Index, double>>& sizes,
                 double rate = 10) {
  Matrix samples = Matrix::Zero(frames, 3);
  for (const auto& [frame, size] : sizes) {
    samples(frame, 0) = 3 * size;
    samples(frame, 1) = 4 * size;
  }
  return joints_of(samples, rate);
}

TEST(StrikesKept, IsOneOfAnUnchangedTake) {
  const Recording take = joints_of(test::random_matrix(60, 9, 1), 30);

  EXPECT_EQ(strikes_kept(take, take), 1);
}

TEST(StrikesKept, IsTheMeanShareOfThePeaks) {
  // At 10 Hz a neighbour is 0.1 s away, a peak of its own: 5 10 5 and 10 20 10.
  const Recording truth = spikes(9, {{2, 1}, {6, 2}}), estimate = spikes(9, {{2, 0.5}, {6, 2}});

  EXPECT_NEAR(strikes_kept(truth, estimate), (3 * 0.5 + 3 * 1) / 6, test::tolerance::by_hand(1));
}

TEST(StrikesKept, TakesOnePeakOfAJointWithinATenthOfASecond) {
  // At 20 Hz the neighbours of a peak are left out; what they keep does not matter.
  const Recording truth = spikes(12, {{2, 1}, {8, 2}}, 20);
  Recording estimate = spikes(12, {{2, 1}, {8, 1}}, 20);

  EXPECT_NEAR(strikes_kept(truth, estimate), (1 + 0.5) / 2, test::tolerance::by_hand(1));

  // Another joint has peaks of its own at the same time.
  Matrix both(12, 6), less(12, 6);
  both << truth.samples, truth.samples;
  less << estimate.samples, truth.samples;
  EXPECT_NEAR(strikes_kept(joints_of(both, 20), joints_of(less, 20)), (1 + 0.5 + 1 + 1) / 4,
              test::tolerance::by_hand(1));
}

TEST(StrikesKept, LooksAtTheTenHardestOnly) {
  std::vector<std::pair<Index, double>> sizes, lost;
  for (Index i = 0; i < 12; ++i) sizes.emplace_back(2 + 4 * i, 12.0 - static_cast<double>(i));
  lost.assign(sizes.begin(), sizes.begin() + 10);

  EXPECT_EQ(strikes_kept(spikes(52, sizes, 20), spikes(52, lost, 20)), 1);
  lost.pop_back();
  EXPECT_NEAR(strikes_kept(spikes(52, sizes, 20), spikes(52, lost, 20)), 0.9,
              test::tolerance::by_hand(1));
}

TEST(StrikesKept, LeavesOutWhatIsMissing) {
  const Recording truth = spikes(12, {{2, 1}, {8, 2}}, 20);
  Recording estimate = spikes(12, {{2, 0.25}, {8, 2}}, 20);
  estimate.samples(8, 2) = std::nan("");

  EXPECT_NEAR(strikes_kept(truth, estimate), 0.25, test::tolerance::by_hand(1));
}

TEST(StrikesKept, NeedsARateAndAMotion) {
  const Recording still = joints_of(Matrix::Zero(8, 3), 30);
  Recording without_rate = spikes(8, {{3, 1}});
  without_rate.frame_rate = 0;

  EXPECT_TRUE(std::isnan(strikes_kept(still, still)));
  EXPECT_TRUE(std::isnan(strikes_kept(without_rate, without_rate)));
  EXPECT_THROW(strikes_kept(still, joints_of(Matrix::Zero(7, 3), 30)), ShapeError);
}

}  // namespace
}  // namespace moclean
