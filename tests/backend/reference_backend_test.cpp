#include "moclean/backend/reference_backend.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/planted.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::ThrowsMessage;

SegmentBatch ragged_batch() {
  return test::planted_batch({.columns = 13, .rank = 2}, {30, 5, 41, 1, 17});
}

TEST(ReferenceBackend, NamesItselfWithItsThreads) {
  EXPECT_THAT(ReferenceBackend(1).name(),
              testing::MatchesRegex("reference \\(Eigen [0-9.]+, 1 thread\\)"));
  EXPECT_THAT(ReferenceBackend(2).name(), testing::HasSubstr("2 threads"));
}

TEST(ReferenceBackend, RefusesLessThanOneJob) {
  EXPECT_THAT([] { ReferenceBackend(0); },
              ThrowsMessage<ArgumentError>("jobs is 0, expected at least 1"));
}

TEST(ReferenceBackend, GivesTheSameBitsForAnyNumberOfJobs) {
  const SegmentBatch data = ragged_batch();

  const Solution alone = ReferenceBackend(1).solve(data, RobustPca{});
  const Solution shared = ReferenceBackend(3).solve(data, RobustPca{});

  EXPECT_TRUE(test::same_bits(alone.low_rank, shared.low_rank));
  EXPECT_TRUE(test::same_bits(alone.sparse, shared.sparse));
}

TEST(ReferenceBackend, SolvesASegmentAsIfItWereAlone) {
  const SegmentBatch data = ragged_batch();
  ReferenceBackend backend;

  const Solution together = backend.solve(data, RobustPca{});

  for (Index b = 0; b < data.segments(); ++b) {
    const Solution alone = backend.solve(test::batch_of({data.segment(b)}), RobustPca{});
    const SegmentOutcome& outcome = together.segments[static_cast<std::size_t>(b)];
    EXPECT_TRUE(test::same_bits(alone.low_rank.segment(0), together.low_rank.segment(b))) << b;
    EXPECT_TRUE(test::same_bits(alone.sparse.segment(0), together.sparse.segment(b))) << b;
    EXPECT_EQ(alone.segments[0].iterations, outcome.iterations);
    EXPECT_EQ(alone.segments[0].rank, outcome.rank);
    EXPECT_EQ(alone.segments[0].residual, outcome.residual);
  }
}

TEST(ReferenceBackend, KeepsThePaddingZero) {
  const Solution solution = ReferenceBackend().solve(ragged_batch(), RobustPca{});

  for (const SegmentBatch* batch : {&solution.low_rank, &solution.sparse})
    for (Index i = 0; i < batch->rows(); ++i)
      for (Index j = batch->columns(); j < batch->pitch(); ++j)
        ASSERT_EQ(batch->storage()[static_cast<std::size_t>(i * batch->pitch() + j)], 0);
}

TEST(ReferenceBackend, SolvesAnEmptyBatch) {
  const Solution solution = ReferenceBackend(2).solve(SegmentBatch(3, {0}), RobustPca{});

  EXPECT_TRUE(solution.segments.empty());
}

TEST(ReferenceBackend, ReportsEverySegmentOnceInOrder) {
  for (const int jobs : {1, 2}) {
    std::vector<Index> finished;
    const Monitor monitor{.report = [&](const Progress& progress) {
      EXPECT_EQ(progress.total, 5);
      finished.push_back(progress.finished);
    }};

    ReferenceBackend(jobs).solve(ragged_batch(), RobustPca{}, monitor);

    EXPECT_THAT(finished, ElementsAre(1, 2, 3, 4, 5)) << jobs;
  }
}

TEST(ReferenceBackend, StopsBeforeTheNextIterationWhenAsked) {
  for (const int jobs : {1, 2}) {
    std::stop_source source;
    int reports = 0;
    const Monitor monitor{.report =
                              [&](const Progress&) {
                                ++reports;
                                source.request_stop();
                              },
                          .stop = source.get_token()};

    EXPECT_THROW(ReferenceBackend(jobs).solve(ragged_batch(), RobustPca{}, monitor), Cancelled);
    EXPECT_LE(reports, jobs);
  }
}

TEST(ReferenceBackend, PassesOnAnExceptionOfTheReport) {
  for (const int jobs : {1, 2}) {
    const Monitor monitor{.report = [](const Progress&) { throw std::runtime_error("full"); }};

    EXPECT_THAT([&] { ReferenceBackend(jobs).solve(ragged_batch(), RobustPca{}, monitor); },
                ThrowsMessage<std::runtime_error>("full"));
  }
}

TEST(ReferenceBackend, RefusesParametersOutOfRange) {
  EXPECT_THROW(ReferenceBackend().solve(ragged_batch(), RobustPca{.rho = 0.5}), ArgumentError);
}

TEST(ReferenceBackend, RefusesSamplesThatAreNotFinite) {
  for (const double bad : {test::nan, -std::numeric_limits<double>::infinity()}) {
    SegmentBatch data = ragged_batch();
    data.segment(2)(12, 3) = bad;

    EXPECT_THAT([&] { ReferenceBackend(2).solve(data, TruncatedSvd{}); },
                ThrowsMessage<ShapeError>("segment 2: not finite at row 12, column 3 (missing "
                                          "samples are not supported by this method)"));
  }
}

TEST(RequireFinite, RefusesEntriesWhoseSquaresOverflow) {
  SegmentBatch data = ragged_batch();
  data.segment(1)(0, 12) = -1e155;

  EXPECT_THAT([&] { require_finite(data); },
              ThrowsMessage<ShapeError>("segment 1: -1e+155 at row 0, column 12 is too large (at "
                                        "most 1e+140 in magnitude)"));
}

TEST(RequireFinite, AcceptsEverythingElse) {
  SegmentBatch data = ragged_batch();
  data.segment(1)(0, 12) = 1e140;
  data.segment(0)(0, 0) = std::numeric_limits<double>::denorm_min();

  EXPECT_NO_THROW(require_finite(data));
}

}  // namespace
}  // namespace moclean
