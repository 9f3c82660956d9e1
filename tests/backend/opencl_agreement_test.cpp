// The device against the reference: the same answer over odd shapes, edge cases and parameters.
#include <gtest/gtest.h>

#include "support/backends.hpp"
#include "support/matrix.hpp"
#include "support/planted.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::BackendKind;

using test::Shape;

void expect_agreement(const SegmentBatch& data, const RobustPca& method,
                      BackendKind tested = BackendKind::opencl_cpu) {
  const Solution device = test::make_backend(tested)->solve(data, method);
  const Solution reference = ReferenceBackend(2).solve(data, method);
  for (Index b = 0; b < data.segments(); ++b) {
    SCOPED_TRACE("segment " + std::to_string(b));
    const auto i = static_cast<std::size_t>(b);
    EXPECT_EQ(device.segments[i].iterations, reference.segments[i].iterations);
    EXPECT_EQ(device.segments[i].rank, reference.segments[i].rank);
    EXPECT_EQ(device.segments[i].converged, reference.segments[i].converged);
    EXPECT_LE(test::relative_difference(device.low_rank.segment(b), reference.low_rank.segment(b)),
              test::tolerance::backends_low_rank());
    EXPECT_LE(test::relative_difference(device.sparse.segment(b), reference.sparse.segment(b)),
              test::tolerance::backends_sparse());
  }
}

class OpenClAgreement : public testing::TestWithParam<std::tuple<BackendKind, UpdateOrder, Shape>> {
};

TEST_P(OpenClAgreement, OnPlantedProblemsOfOddShapes) {
  const auto& [kind, order, shape] = GetParam();
  const SegmentBatch data =
      test::planted_batch({.columns = shape.columns, .rank = 1 + shape.columns / 10},
                          {shape.rows, shape.rows + 1, shape.rows});

  // With one row or column and lambda = 1/sqrt(max(rows, columns)), |Y|_2 <= 1 and max|Y_ij| <=
  // lambda touch in one point: whether A is 0 or 1e-16 is decided by rounding. Another lambda has
  // an answer.
  const bool degenerate = std::min(shape.rows, shape.columns) == 1;
  expect_agreement(data, {.lambda_scale = degenerate ? 1.1 : 1, .order = order}, kind);
}

std::string name_of_agreement(const testing::TestParamInfo<OpenClAgreement::ParamType>& parameter) {
  const auto& [kind, order, shape] = parameter.param;
  return to_string(kind) + "_" + to_string(order) + "_" + std::to_string(shape.rows) + "x" +
         std::to_string(shape.columns);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, OpenClAgreement,
    testing::Combine(testing::Values(BackendKind::opencl_cpu, BackendKind::opencl_clblast,
                                     BackendKind::opencl_gpu128),
                     testing::Values(UpdateOrder::ae, UpdateOrder::ea),
                     testing::Values(Shape{1, 1}, Shape{3, 5}, Shape{64, 64}, Shape{200, 93},
                                     Shape{61, 129}, Shape{25, 93}, Shape{100, 1}, Shape{1, 93})),
    name_of_agreement);

INSTANTIATE_TEST_SUITE_P(
    WorkGroups, OpenClAgreement,
    testing::Combine(testing::Values(BackendKind::opencl_gpu64, BackendKind::opencl_gpu256),
                     testing::Values(UpdateOrder::ae, UpdateOrder::ea),
                     testing::Values(Shape{3, 5}, Shape{25, 93}, Shape{70, 33})),
    name_of_agreement);

// All kernels, in so few steps that Oclgrind, which interprets them, is soon done; 257 rows are two
// blocks.
class OpenClFirstIterations : public testing::TestWithParam<BackendKind> {};

TEST_P(OpenClFirstIterations, AgreeOnATinyProblem) {
  expect_agreement(test::planted_batch({.columns = 5, .rank = 1}, {3, 257}), {.max_iterations = 2},
                   GetParam());
}

INSTANTIATE_TEST_SUITE_P(Forms, OpenClFirstIterations,
                         testing::Values(BackendKind::opencl_cpu, BackendKind::opencl_gpu64),
                         [](const auto& parameter) { return to_string(parameter.param); });

class OpenClEdgeCases : public testing::TestWithParam<std::tuple<BackendKind, UpdateOrder>> {
 protected:
  void expect_agreement(const SegmentBatch& data) const {
    moclean::expect_agreement(data, method_, kind_);
  }

  BackendKind kind_ = std::get<0>(GetParam());
  RobustPca method_{.order = std::get<1>(GetParam())};
};

TEST_P(OpenClEdgeCases, ConstantColumns) {
  Matrix data = test::random_matrix(50, 12, 1);
  data.leftCols(6).setConstant(3.5);

  expect_agreement(test::batch_of({data, Matrix::Constant(50, 12, -2)}));
}

TEST_P(OpenClEdgeCases, OneFrameOrOneColumnWithTheDegenerateDefaultLambda) {
  for (const Matrix& data : {test::random_matrix(1, 93, 4), test::random_matrix(100, 1, 5)}) {
    const SegmentBatch batch = test::batch_of({data});

    const Solution device = test::make_backend(kind_)->solve(batch, method_);
    const Solution reference = ReferenceBackend(1).solve(batch, method_);

    EXPECT_EQ(device.segments[0].iterations, reference.segments[0].iterations);
    EXPECT_LE(test::largest_difference(device.low_rank.segment(0), reference.low_rank.segment(0)),
              test::tolerance::by_hand(data.norm()));
    EXPECT_LE(test::largest_difference(device.sparse.segment(0), reference.sparse.segment(0)),
              test::tolerance::by_hand(data.norm()));
  }
}

TEST_P(OpenClEdgeCases, RankOne) {
  const Matrix data = test::random_matrix(40, 1, 2) * test::random_matrix(1, 30, 3);

  expect_agreement(test::batch_of({data}));
}

// Whose residual falls to nothing in one iteration, so that none before it was taken for the last.
TEST_P(OpenClEdgeCases, SegmentsThatConvergeAtOnceAmongOthers) {
  const Matrix rank_one = test::random_matrix(50, 1, 1) * test::random_matrix(1, 20, 2);
  const SegmentBatch planted = test::planted_batch({.columns = 20, .rank = 2}, {50});
  expect_agreement(test::batch_of({rank_one, planted.segment(0), rank_one.topRows(10)}));
}

TEST_P(OpenClEdgeCases, TinyAndHugeValues) {
  const Matrix data = test::planted({.rows = 60, .columns = 20}).data();

  expect_agreement(test::batch_of({1e-12 * data, 1e12 * data}));
}

TEST_P(OpenClEdgeCases, AlreadyLowRankData) {
  expect_agreement(test::planted_batch({.columns = 30, .rank = 4, .error_share = 0}, {80}));
}

TEST_P(OpenClEdgeCases, NoSurvivingSingularValue) {
  // A dear low-rank part: 1/mu stays above every singular value in the first iterations.
  method_.mu0_factor = 0.01;
  method_.max_iterations = 2;
  const SegmentBatch data = test::planted_batch({.columns = 20}, {40});

  const Solution solution = test::make_backend(kind_)->solve(data, method_);

  EXPECT_EQ(solution.segments[0].rank, 0);
  EXPECT_EQ(solution.low_rank.segment(0).norm(), 0);
  expect_agreement(data);
}

TEST_P(OpenClEdgeCases, OtherParameters) {
  const SegmentBatch data = test::planted_batch({.columns = 20}, {40, 70});

  method_.lambda = 0.2;
  expect_agreement(data);
  method_ = {.lambda_scale = 1.7,
             .rho = 1.2,
             .mu_max_factor = 1e5,
             .tolerance = 1e-5,
             .order = std::get<1>(GetParam())};
  expect_agreement(data);
}

INSTANTIATE_TEST_SUITE_P(Orders, OpenClEdgeCases,
                         testing::Combine(testing::Values(BackendKind::opencl_cpu,
                                                          BackendKind::opencl_gpu128),
                                          testing::Values(UpdateOrder::ae, UpdateOrder::ea)),
                         [](const auto& parameter) {
                           return to_string(std::get<0>(parameter.param)) + "_" +
                                  to_string(std::get<1>(parameter.param));
                         });

TEST(OpenClBackend, CutsABatchThatExceedsTheMemoryLimitWithoutChangingABit) {
  const SegmentBatch data =
      test::planted_batch({.columns = 21, .rank = 2}, {50, 12, 33, 90, 41, 60});
  OpenClBackend whole(test::device());
  OpenClBackend small(test::device(), {.memory_limit = 200 * 1024});

  const Solution expected = whole.solve(data, RobustPca{});
  const Solution cut = small.solve(data, RobustPca{});

  EXPECT_TRUE(test::same_bits(cut.low_rank, expected.low_rank));
  EXPECT_TRUE(test::same_bits(cut.sparse, expected.sparse));
}

TEST(OpenClBackend, SaysSoWhenOneSegmentExceedsTheMemoryLimit) {
  OpenClBackend tiny(test::device(), {.memory_limit = 1024});

  EXPECT_THROW(tiny.solve(test::planted_batch({.columns = 21}, {50}), RobustPca{}), DeviceError);
}

TEST(OpenClBackend, RepeatsBitForBit) {
  const SegmentBatch data = test::planted_batch({.columns = 93, .rank = 9}, {200, 150});
  OpenClBackend backend(test::device());

  const Solution first = backend.solve(data, RobustPca{});
  const Solution second = backend.solve(data, RobustPca{});

  EXPECT_TRUE(test::same_bits(first.low_rank, second.low_rank));
  EXPECT_TRUE(test::same_bits(first.sparse, second.sparse));
}

}  // namespace
}  // namespace moclean
