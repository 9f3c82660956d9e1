// Missing samples (NaN): how gaps are filled to start from, and robust PCA with weight 0 there.
#include "moclean/solve/missing.hpp"

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/methods/robust_pca/reference.hpp"

#include "support/backends.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/planted.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::BackendKind;
using test::nan;

Matrix with_missing(Matrix data, double share, std::uint64_t seed) {
  Random random(seed);
  for (double& entry : data.reshaped<Eigen::RowMajor>())
    if (random.uniform() < share) entry = nan;
  return data;
}

TEST(FilledAlongTime, RunsStraightThroughAGapAndLevelAtTheEnds) {
  const Matrix data{{nan, 1, nan}, {2, nan, nan}, {nan, nan, nan}, {8, 7, nan}, {nan, 9, nan}};

  const Matrix filled = filled_along_time(data);

  EXPECT_EQ(filled, (Matrix{{2, 1, 0}, {2, 3, 0}, {5, 5, 0}, {8, 7, 0}, {8, 9, 0}}));
  EXPECT_EQ(observed_part(data).sum(), 27);
  EXPECT_EQ(observed_entries(data).sum(), 5);
  EXPECT_TRUE(has_missing(data));
  EXPECT_FALSE(has_missing(filled));
}

class RobustPcaWithMissing : public testing::TestWithParam<UpdateOrder> {
 protected:
  RobustPca method() const { return {.order = GetParam()}; }
};

INSTANTIATE_TEST_SUITE_P(Orders, RobustPcaWithMissing,
                         testing::Values(UpdateOrder::ae, UpdateOrder::ea),
                         [](const auto& order) { return to_string(order.param); });

TEST_P(RobustPcaWithMissing, FillsAPlantedProblem) {
  const test::Planted problem = test::planted({.rows = 80, .columns = 60, .rank = 2});
  const Matrix data = with_missing(problem.data(), 0.1, 3);

  const auto s = reference::solve(data, method());

  EXPECT_LE(test::relative_difference(s.low_rank, problem.low_rank), test::tolerance::recovery());
  EXPECT_EQ((data.array().isNaN()).select(s.sparse, 0).norm(), 0);
  EXPECT_EQ((data.array().isNaN()).select(s.multipliers, 0).norm(), 0);
  EXPECT_TRUE(s.outcome.converged);
}

TEST_P(RobustPcaWithMissing, ReportsTheResidualOfWhatWasObserved) {
  const Matrix data = with_missing(test::planted({}).data(), 0.2, 4);
  const Matrix observed = observed_part(data), seen = observed_entries(data);

  const auto s = reference::solve(data, method());

  const Matrix rest = seen.cwiseProduct(observed - s.low_rank - s.sparse);
  EXPECT_NEAR(s.outcome.residual, rest.norm() / observed.norm(), test::tolerance::by_hand(1));
}

TEST_P(RobustPcaWithMissing, ScalesWithItsData) {
  const Matrix data = with_missing(test::planted({}).data(), 0.1, 5);

  const auto s = reference::solve(data, method());
  const auto twice = reference::solve(2 * data, method());

  EXPECT_LE(test::relative_difference(twice.low_rank, 2 * s.low_rank),
            test::tolerance::same_iteration(60));
}

TEST_P(RobustPcaWithMissing, CompleteSegmentsAmongOthersKeepEveryBit) {
  for (const BackendKind kind : {BackendKind::opencl_cpu, BackendKind::opencl_clblast}) {
    const Matrix complete = test::planted({.rows = 70, .columns = 21}).data();
    const Matrix holey = with_missing(complete.topRows(50), 0.1, 6);
    const auto backend = test::make_backend(kind);

    const Solution alone = backend->solve(test::batch_of({complete}), method());
    const Solution holey_alone = backend->solve(test::batch_of({holey}), method());
    const Solution mixed = backend->solve(test::batch_of({holey, complete, holey}), method());

    EXPECT_TRUE(
        test::same_bits(Matrix(mixed.low_rank.segment(1)), Matrix(alone.low_rank.segment(0))));
    EXPECT_TRUE(test::same_bits(Matrix(mixed.sparse.segment(1)), Matrix(alone.sparse.segment(0))));
    for (const Index b : {0, 2})
      EXPECT_TRUE(test::same_bits(Matrix(mixed.low_rank.segment(b)),
                                  Matrix(holey_alone.low_rank.segment(0))));
  }
}

TEST_P(RobustPcaWithMissing, NothingObservedIsSolvedWithoutAnIteration) {
  for (const BackendKind kind : {BackendKind::reference, BackendKind::opencl_cpu}) {
    const Solution s = test::make_backend(kind)->solve(
        test::batch_of({Matrix::Constant(7, 5, nan), test::random_matrix(9, 5, 1)}), method());

    EXPECT_EQ(s.segments[0].iterations, 0);
    EXPECT_TRUE(s.segments[0].converged);
    EXPECT_EQ(s.low_rank.segment(0).norm(), 0);
    EXPECT_GT(s.segments[1].iterations, 0);
  }
}

using test::Shape;

class MissingAgreement
    : public testing::TestWithParam<std::tuple<BackendKind, UpdateOrder, Shape>> {};

TEST_P(MissingAgreement, DeviceAgreesWithTheReference) {
  const auto& [kind, order, shape] = GetParam();
  std::vector<Matrix> segments;
  for (const Index more : {0, 1, 5}) {
    const Matrix data = test::planted({.rows = shape.rows + more,
                                       .columns = shape.columns,
                                       .rank = 2,
                                       .seed = static_cast<std::uint64_t>(more + 1)})
                            .data();
    segments.push_back(with_missing(data, more == 1 ? 0 : 0.15, 9));
  }
  segments[0].col(0).setConstant(nan);
  const SegmentBatch data = test::batch_of(segments);
  const RobustPca method{.lambda_scale = 1.1, .order = order};

  const Solution device = test::make_backend(kind)->solve(data, method);
  const Solution reference = ReferenceBackend(2).solve(data, method);

  for (Index b = 0; b < data.segments(); ++b) {
    SCOPED_TRACE("segment " + std::to_string(b));
    const auto i = static_cast<std::size_t>(b);
    EXPECT_EQ(device.segments[i].iterations, reference.segments[i].iterations);
    EXPECT_EQ(device.segments[i].rank, reference.segments[i].rank);
    EXPECT_LE(test::relative_difference(device.low_rank.segment(b), reference.low_rank.segment(b)),
              test::tolerance::backends_low_rank());
    EXPECT_LE((device.sparse.segment(b) - reference.sparse.segment(b)).norm(),
              test::tolerance::backends_sparse() * observed_part(data.segment(b)).norm());
  }
}

std::string name_of_missing(const testing::TestParamInfo<MissingAgreement::ParamType>& parameter) {
  const auto& [kind, order, shape] = parameter.param;
  return to_string(kind) + "_" + to_string(order) + "_" + std::to_string(shape.rows) + "x" +
         std::to_string(shape.columns);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, MissingAgreement,
    testing::Combine(testing::Values(BackendKind::opencl_cpu, BackendKind::opencl_clblast,
                                     BackendKind::opencl_gpu64),
                     testing::Values(UpdateOrder::ae, UpdateOrder::ea),
                     testing::Values(Shape{3, 5}, Shape{64, 64}, Shape{300, 21}, Shape{25, 93})),
    name_of_missing);

TEST(MissingSamples, NeedDoublePrecision) {
  OpenClBackend mixed(test::device(), {.precision = Precision::mixed});
  const SegmentBatch data = test::batch_of({with_missing(test::planted({}).data(), 0.1, 2)});

  EXPECT_THAT([&] { mixed.solve(data, RobustPca{.tolerance = 1e-6}); },
              testing::ThrowsMessage<ArgumentError>("missing samples need double precision (f64)"));
}

}  // namespace
}  // namespace moclean
