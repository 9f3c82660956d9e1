#include "moclean/denoise/cheapest_plans.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/denoise/low_rank.hpp"
#include "moclean/metric/metric.hpp"
#include "moclean/noise/noise.hpp"
#include "moclean/segment/cheapest_plan.hpp"

#include "support/matrix.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;

// Three motions of rank 2 in 12 columns, one after the other: each a pair of harmonics of its own,
// mixed into the columns at random. A segment across a change has rank 4.
Recording three_motions(Index frames, Index first_change, Index second_change,
                        std::uint64_t seed = 1) {
  constexpr Index columns = 12;
  Random random(seed);
  Recording take{.samples = Matrix(frames, columns),
                 .columns = default_column_names(columns),
                 .frame_rate = 120,
                 .unit = ""};
  Matrix mix(6, columns);
  for (double& entry : mix.reshaped()) entry = 6 * random.uniform() - 3;
  for (Index f = 0; f < frames; ++f) {
    const Index motion = f < first_change ? 0 : f < second_change ? 1 : 2;
    const double turn = 0.1 * static_cast<double>(f);
    take.samples.row(f) =
        std::sin(turn) * mix.row(2 * motion) + std::cos(0.7 * turn) * mix.row(2 * motion + 1);
  }
  return take;
}

Recording noisy(const Recording& take) {
  return corrupt(take, GaussianFrames{.fraction = 0.3, .mean = 1, .sd = 1.2}, 1).clip;
}

std::vector<SegmentPlan> plans_of(const std::vector<Recording>& takes,
                                  std::vector<Index> segments) {
  ReferenceBackend backend(2);
  return cheapest_plans(takes, segments, RobustPca{}, backend);
}

TEST(AutomaticPlans, CutWhereTheMotionChanges) {
  const Recording take = noisy(three_motions(240, 60, 180));  // parts of 20 frames

  EXPECT_THAT(plans_of({take}, {3}).at(0), ElementsAre(0, 60, 180, 240));
}

TEST(AutomaticPlans, AreTheSameTogetherAndAloneAndAgain) {
  Recording narrow = noisy(three_motions(200, 120, 160, 3));
  narrow.samples.conservativeResize(200, 9);
  narrow.columns.resize(9);
  const std::vector<Recording> takes = {noisy(three_motions(240, 60, 180)), narrow,
                                        noisy(three_motions(160, 60, 100, 2))};

  const std::vector<SegmentPlan> together = plans_of(takes, {3, 2, 2});

  EXPECT_EQ(together, plans_of(takes, {3, 2, 2}));
  EXPECT_EQ(together[0], plans_of({takes[0]}, {3})[0]);
  EXPECT_EQ(together[1], plans_of({takes[1]}, {2})[0]);
  EXPECT_EQ(together[2], plans_of({takes[2]}, {2})[0]);
}

TEST(AutomaticPlans, DivideShortTakesEqually) {
  const Recording take = noisy(three_motions(40, 10, 30));

  EXPECT_THAT(plans_of({take}, {1}).at(0), ElementsAre(0, 40));
  EXPECT_THAT(plans_of({take}, {3}).at(0), ElementsAre(0, 13, 26, 40));
}

TEST(AutomaticPlans, StopWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  const std::vector<Recording> takes = {noisy(three_motions(240, 60, 180))};
  const std::vector<Index> segments = {3};
  ReferenceBackend backend(1);

  EXPECT_THROW(cheapest_plans(takes, segments, {}, backend, stop.get_token()), Cancelled);
}

TEST(AutomaticSegments, BringSlraCloserToTheTruthThanEqualOnes) {
  const Recording truth = three_motions(240, 60, 180);
  const Recording take = noisy(truth);
  ReferenceBackend backend(2);
  const auto fd = [&](const Segmentation& segmentation) {
    const Denoised result =
        LowRankDenoiser(segmentation, RobustPca{}, backend).denoise({&take, 1}).at(0);
    EXPECT_EQ(result.segments.size(), 3u);
    return frobenius_distance(truth.samples, result.motion);
  };

  EXPECT_LT(fd({.segments = 3, .cheapest = true}), 0.9 * fd({.segments = 3}));
}

}  // namespace
}  // namespace moclean
