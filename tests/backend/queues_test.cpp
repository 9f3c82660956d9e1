// Batches in flight at the same time: the same bits, limits and contract as one after the other.

#include <algorithm>
#include <optional>
#include <stdexcept>

#include <gmock/gmock.h>

#include "moclean/backend/opencl_backend.hpp"

#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/planted.hpp"

namespace moclean {
namespace {

// Tall, square, wide and single-frame segments, more than two sets of lanes of them.
SegmentBatch odd_segments() {
  std::vector<Index> rows;
  for (int i = 0; i < 3; ++i) rows.insert(rows.end(), {25, 40, 61, 31, 7, 90, 1});
  return test::planted_batch({.columns = 31, .rank = 4}, rows);
}

void expect_same_bits(const Solution& a, const Solution& b) {
  EXPECT_TRUE(test::same_bits(a.low_rank.storage(), b.low_rank.storage()));
  EXPECT_TRUE(test::same_bits(a.sparse.storage(), b.sparse.storage()));
  for (std::size_t s = 0; s < a.segments.size(); ++s) {
    EXPECT_EQ(a.segments[s].iterations, b.segments[s].iterations);
    EXPECT_EQ(a.segments[s].rank, b.segments[s].rank);
    EXPECT_EQ(a.segments[s].residual, b.segments[s].residual);
    EXPECT_EQ(a.segments[s].converged, b.segments[s].converged);
  }
}

struct Case {
  const char* name;
  UpdateOrder order = UpdateOrder::ae;
  Precision precision = Precision::f64;
  KernelForm eigen = KernelForm::cpu;
  KernelForm form = KernelForm::cpu;
  ProductPath products = ProductPath::own;
};

class QueuesTest : public testing::TestWithParam<Case> {};

TEST_P(QueuesTest, LeaveEveryBit) {
  const Case& c = GetParam();
  const SegmentBatch data = odd_segments();
  const RobustPca method{.tolerance = c.precision == Precision::mixed ? mixed_tolerance : 1e-7,
                         .order = c.order};
  const auto solve = [&](int queues, std::int64_t batch_segments) {
    const Tuning tuning{.form = c.form,
                        .products = c.products,
                        .eigen = c.eigen,
                        .batch_segments = batch_segments,
                        .queues = queues};
    OpenClBackend backend(test::device(), {.precision = c.precision, .tuning = tuning});
    return backend.solve(data, method);
  };
  const Solution expected = solve(1, 0);

  for (const int queues : {1, 2, 3})
    for (const std::int64_t batch_segments : {0, 1, 5}) {
      SCOPED_TRACE(testing::Message() << queues << " queues, batch " << batch_segments);
      expect_same_bits(solve(queues, batch_segments), expected);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Modes, QueuesTest,
    testing::Values(Case{.name = "ae"}, Case{.name = "ea", .order = UpdateOrder::ea},
                    Case{.name = "mixed", .precision = Precision::mixed},
                    Case{.name = "group", .eigen = KernelForm::gpu},
                    Case{.name = "clblast", .products = ProductPath::clblast},
                    Case{.name = "gpu", .eigen = KernelForm::gpu, .form = KernelForm::gpu}),
    [](const auto& parameter) { return parameter.param.name; });

// The limit is searched for: the least that does not throw holds the largest segment alone.
TEST(Queues, MemoryForOneSegmentOnlyGivesTheSameBits) {
  const SegmentBatch data = odd_segments();
  const Tuning tuning{.queues = 3};
  const auto solve = [&](std::uint64_t limit) -> std::optional<Solution> {
    OpenClBackend backend(test::device(), {.memory_limit = limit, .tuning = tuning});
    try {
      return backend.solve(data, RobustPca{.max_iterations = 5});
    } catch (const DeviceError&) {
      return std::nullopt;
    }
  };
  std::uint64_t too_little = 1, enough = std::uint64_t{1} << 24;
  while (enough - too_little > 1) {
    const std::uint64_t limit = (too_little + enough) / 2;
    (solve(limit) ? enough : too_little) = limit;
  }

  const std::optional<Solution> least = solve(enough);

  ASSERT_TRUE(least);
  expect_same_bits(*least, *solve(std::uint64_t{1} << 30));
}

TEST(Queues, ReportsAreSerialisedAndComplete) {
  OpenClBackend backend(test::device(), {.tuning = Tuning{.batch_segments = 2, .queues = 3}});
  std::vector<Progress> reports;

  backend.solve(odd_segments(), RobustPca{},
                {.report = [&](const Progress& progress) { reports.push_back(progress); }});

  ASSERT_FALSE(reports.empty());
  for (std::size_t i = 1; i < reports.size(); ++i)
    EXPECT_GT(reports[i].finished, reports[i - 1].finished);
  EXPECT_EQ(reports.back().finished, 21);
}

TEST(Queues, ReportThatThrowsEndsTheSolveAndTheNextOneIsRight) {
  const SegmentBatch data = odd_segments();
  OpenClBackend backend(test::device(), {.tuning = Tuning{.batch_segments = 2, .queues = 3}});
  const Solution expected = backend.solve(data, RobustPca{});
  const Monitor throws{.report = [](const Progress&) { throw std::length_error("enough"); }};

  EXPECT_THROW(backend.solve(data, RobustPca{}, throws), std::length_error);

  expect_same_bits(backend.solve(data, RobustPca{}), expected);
}

TEST(Queues, StopEndsAllOfThem) {
  OpenClBackend backend(test::device(), {.tuning = Tuning{.batch_segments = 1, .queues = 3}});
  std::stop_source source;
  Index finished = 0;
  const Monitor stops{.report =
                          [&](const Progress& progress) {
                            finished = progress.finished;
                            source.request_stop();
                          },
                      .stop = source.get_token()};

  EXPECT_THROW(backend.solve(odd_segments(), RobustPca{}, stops), Cancelled);

  EXPECT_LT(finished, 21);
}

TEST(Queues, ProfileSeesTheLaunchesOfAll) {
  const Device profiled(test::device().info().name, Profiling::on);
  const SegmentBatch data = odd_segments();
  const auto calls_of_sweep = [&](int queues) {
    profiled.profile()->clear();
    OpenClBackend(profiled, {.tuning = Tuning{.batch_segments = 5, .queues = queues}})
        .solve(data, RobustPca{});
    const auto kernels = profiled.profile()->kernels();
    double sum = 0;
    for (const KernelProfile& kernel : kernels) sum += kernel.seconds;
    EXPECT_GT(profiled.profile()->busy_seconds(), 0);
    EXPECT_LE(profiled.profile()->busy_seconds(), sum * (1 + 1e-9));
    return std::ranges::find(kernels, "sweep_full", &KernelProfile::kernel)->calls;
  };

  EXPECT_EQ(calls_of_sweep(3), calls_of_sweep(1));
}

}  // namespace
}  // namespace moclean
