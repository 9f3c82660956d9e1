#include "moclean/denoise/low_rank.hpp"

#include <gmock/gmock.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/metric/metric.hpp"
#include "moclean/noise/noise.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;
using testing::ElementsAre;
using testing::ThrowsMessage;

Recording noisy_walk(Index frames, std::uint64_t seed) {
  return corrupt(test::synthetic_walk(frames, seed), GaussianFrames{.fraction = 0.3}, seed).clip;
}

// A take of fewer columns than the walk's 93.
Recording narrow(const Recording& clip, Index columns) {
  Recording result = clip;
  result.samples = clip.samples.leftCols(columns);
  result.columns.resize(static_cast<std::size_t>(columns));
  return result;
}

std::vector<Denoised> denoise(const std::vector<Recording>& takes, const Segmentation& segmentation,
                              const Monitor& monitor = {}) {
  ReferenceBackend backend(2);
  return LowRankDenoiser(segmentation, RobustPca{}, backend).denoise(takes, monitor);
}

TEST(SegmentationPlan, PrefersWholeThenANumberThenALength) {
  EXPECT_THAT(plan({.whole = true, .segments = 3, .length = 10}, 100), ElementsAre(0, 100));
  EXPECT_THAT(plan({.segments = 2, .length = 10}, 100), ElementsAre(0, 50, 100));
  EXPECT_THAT(plan({.length = 50}, 100), ElementsAre(0, 50, 100));
  EXPECT_THAT(plan({}, 400), ElementsAre(0, 200, 400));
  EXPECT_THROW(plan({.segments = -1}, 100), ArgumentError);
}

TEST(LowRankDenoiser, SplitsATakeIntoMotionAndOutliers) {
  const Recording take = noisy_walk(120, 1);

  const Denoised result = denoise({take}, {.length = 40}).at(0);

  const Matrix sum = result.motion + result.outliers;
  EXPECT_LE(test::relative_difference(sum, take.samples), RobustPca{}.tolerance);
}

TEST(LowRankDenoiser, StitchesTheSolutionsOfItsSegments) {
  const Recording take = noisy_walk(100, 1);

  const Denoised result = denoise({take}, {.segments = 3}).at(0);

  ASSERT_EQ(result.segments.size(), 3u);
  for (const DenoisedSegment& segment : result.segments) {
    const Matrix rows = take.samples.middleRows(segment.first_frame, segment.frames);
    const Solution alone = ReferenceBackend().solve(test::batch_of({rows}), RobustPca{});
    const auto own = [&](const Matrix& samples) -> Matrix {
      return samples.middleRows(segment.first_frame, segment.frames);
    };
    EXPECT_TRUE(test::same_bits(own(result.motion), Matrix(alone.low_rank.segment(0))));
    EXPECT_TRUE(test::same_bits(own(result.outliers), Matrix(alone.sparse.segment(0))));
    EXPECT_EQ(segment.outcome.iterations, alone.segments[0].iterations);
    EXPECT_EQ(segment.outcome.rank, alone.segments[0].rank);
  }
  EXPECT_EQ(result.segments[2].first_frame, 66);
  EXPECT_EQ(result.segments[2].frames, 34);
}

TEST(LowRankDenoiser, SolvesTheWholeTakeAsOneSegment) {
  const Denoised result = denoise({noisy_walk(100, 1)}, {.whole = true}).at(0);

  ASSERT_EQ(result.segments.size(), 1u);
  EXPECT_EQ(result.segments[0].first_frame, 0);
  EXPECT_EQ(result.segments[0].frames, 100);
}

TEST(LowRankDenoiser, GivesTheSameBitsForTakesTogetherAndAlone) {
  const std::vector<Recording> takes = {noisy_walk(90, 1), narrow(noisy_walk(70, 2), 12),
                                        noisy_walk(45, 3), narrow(noisy_walk(30, 4), 12)};

  const std::vector<Denoised> together = denoise(takes, {.length = 40});

  ASSERT_EQ(together.size(), takes.size());
  for (std::size_t t = 0; t < takes.size(); ++t) {
    const Denoised alone = denoise({takes[t]}, {.length = 40}).at(0);
    EXPECT_TRUE(test::same_bits(together[t].motion, alone.motion)) << t;
    EXPECT_TRUE(test::same_bits(together[t].outliers, alone.outliers)) << t;
    EXPECT_EQ(together[t].segments.size(), alone.segments.size());
  }
}

TEST(LowRankDenoiser, GivesTheSameBitsTogetherAndAloneWithOverlap) {
  const std::vector<Recording> takes = {noisy_walk(60, 1), noisy_walk(45, 3)};
  const Segmentation segmentation{.length = 20, .overlap = 8};

  const std::vector<Denoised> together = denoise(takes, segmentation);

  for (std::size_t t = 0; t < takes.size(); ++t)
    EXPECT_TRUE(test::same_bits(together[t].motion, denoise({takes[t]}, segmentation).at(0).motion))
        << t;
}

TEST(LowRankDenoiser, SharesTheSolveTimeByFrames) {
  const auto results = denoise({noisy_walk(90, 1), noisy_walk(30, 2)}, {.length = 30});

  EXPECT_GT(results[1].solve_seconds, 0);
  EXPECT_NEAR(results[0].solve_seconds / results[1].solve_seconds, 3, test::tolerance::by_hand(3));
}

TEST(LowRankDenoiser, SharesTheSolveTimeByFramesSolved) {
  const auto results =
      denoise({noisy_walk(60, 1), noisy_walk(30, 2)}, {.length = 30, .overlap = 10});

  EXPECT_NEAR(results[0].solve_seconds / results[1].solve_seconds, 7.0 / 3,
              test::tolerance::by_hand(3));
}

TEST(LowRankDenoiser, CountsProgressOverTakesOfAllWidths) {
  std::vector<Index> finished;
  const Monitor monitor{.report = [&](const Progress& progress) {
    EXPECT_EQ(progress.total, 4);
    finished.push_back(progress.finished);
  }};

  denoise({noisy_walk(60, 1), narrow(noisy_walk(60, 2), 12)}, {.length = 30}, monitor);

  EXPECT_THAT(finished, ElementsAre(1, 2, 3, 4));
}

TEST(LowRankDenoiser, HandsTheStopRequestOn) {
  std::stop_source source;
  source.request_stop();
  const Monitor monitor{.stop = source.get_token()};

  EXPECT_THROW(denoise({noisy_walk(60, 1)}, {}, monitor), Cancelled);
}

TEST(LowRankDenoiser, AcceptsNoTakes) { EXPECT_TRUE(denoise({}, {}).empty()); }

TEST(LowRankDenoiser, RefusesMissingSamplesByTakeFrameAndColumn) {
  std::vector<Recording> takes = {noisy_walk(30, 1), noisy_walk(30, 2)};
  takes[1].samples(7, 4) = nan;

  ReferenceBackend backend;
  LowRankDenoiser denoiser({}, TruncatedSvd{}, backend);

  EXPECT_THAT([&] { denoiser.denoise(takes); },
              ThrowsMessage<ShapeError>("take 1: not finite at frame 7, column joint1.y (missing "
                                        "samples are not supported by this method)"));
}

TEST(LowRankDenoiser, LeavesAColumnThatWasNeverObservedMissingAndNamesIt) {
  Recording take = noisy_walk(60, 1);
  take.samples.col(4).setConstant(nan);
  take.samples.block(10, 9, 8, 3).setConstant(nan);
  take.samples.block(0, 20, 30, 1).setConstant(nan);  // the whole of the first segment
  ReferenceBackend backend;

  for (const Method& method :
       {Method(RobustPca{}), Method(MatrixCompletion{}), Method(TemporalRobustPca{})}) {
    LowRankDenoiser denoiser({.length = 30}, method, backend);
    const Denoised result = denoiser.denoise({&take, 1}).at(0);

    EXPECT_THAT(result.unobserved, ElementsAre("joint1.y"));
    EXPECT_TRUE(result.motion.col(4).array().isNaN().all());
    EXPECT_EQ(result.motion.array().isNaN().count(), 60);
    EXPECT_TRUE(result.outliers.allFinite());
    EXPECT_EQ(result.outliers.col(4).norm(), 0);
  }
  EXPECT_THAT(denoise({noisy_walk(60, 1)}, {})[0].unobserved, ElementsAre());
}

TEST(LowRankDenoiser, RefusesEmptyAndMisnamedTakes) {
  Recording empty = noisy_walk(30, 1);
  empty.samples.resize(0, 93);
  Recording misnamed = noisy_walk(30, 1);
  misnamed.columns.pop_back();

  EXPECT_THAT([&] { denoise({empty}, {}); },
              ThrowsMessage<ShapeError>("take 0 is empty (0 frames x 93 columns)"));
  EXPECT_THAT([&] { denoise({misnamed}, {}); },
              ThrowsMessage<ShapeError>("take 0 names 92 columns but has 93"));
}

// As in the paper's tables: cleaning helps, and short segments help more than the whole take.
// Measured here: noisy 0.63, whole 0.21, 200 frames 0.12.
TEST(LowRankDenoiser, BringsAWalkCloserToTheTruthWithShorterSegments) {
  const Recording truth = test::synthetic_walk(1200);
  const Recording noisy = corrupt(truth, GaussianFrames{.frames = 400}, 1).clip;
  const auto fd = [&](const Matrix& motion) { return frobenius_distance(truth.samples, motion); };

  const Matrix whole = denoise({noisy}, {.whole = true}).at(0).motion;
  const Matrix segmented = denoise({noisy}, {.length = 200}).at(0).motion;

  EXPECT_LT(fd(whole), fd(noisy.samples) / 2);
  EXPECT_LT(fd(segmented), fd(whole));
}

}  // namespace
}  // namespace moclean
