// What every backend promises for every method, whatever the answer is.
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "moclean/core/error.hpp"

#include "support/backends.hpp"
#include "support/matrix.hpp"
#include "support/planted.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::BackendKind;
using testing::HasSubstr;

class BackendContract : public testing::TestWithParam<std::tuple<BackendKind, UpdateOrder>> {
 protected:
  BackendContract() : backend_(test::make_backend(std::get<0>(GetParam()))) {
    method_.order = std::get<1>(GetParam());
  }

  Solution solve(const SegmentBatch& data) { return backend_->solve(data, method_); }

  std::unique_ptr<Backend> backend_;
  RobustPca method_;
};

// Different lengths, one of them wide (rows < columns).
SegmentBatch ragged() { return test::planted_batch({.columns = 21, .rank = 2}, {50, 12, 33, 90}); }

TEST_P(BackendContract, SumOfThePartsIsTheData) {
  const SegmentBatch data = ragged();

  const Solution s = solve(data);

  for (Index b = 0; b < data.segments(); ++b) {
    const SegmentOutcome& outcome = s.segments[static_cast<std::size_t>(b)];
    const Matrix d = data.segment(b), a = s.low_rank.segment(b), e = s.sparse.segment(b);
    EXPECT_TRUE(outcome.converged);
    EXPECT_LE(outcome.residual, method_.tolerance);
    EXPECT_NEAR((d - a - e).norm() / d.norm(), outcome.residual,
                test::tolerance::decomposition(d.rows()));
  }
}

TEST_P(BackendContract, RecoversAPlantedLowRankAndSparsePart) {
  const test::Planted planted = test::planted({.rows = 60, .columns = 40, .rank = 3});

  const Solution s = solve(test::batch_of({planted.data()}));

  EXPECT_EQ(s.segments[0].rank, 3);
  EXPECT_LE(test::relative_difference(s.low_rank.segment(0), planted.low_rank),
            test::tolerance::recovery());
  EXPECT_LE(test::relative_difference(s.sparse.segment(0), planted.sparse),
            test::tolerance::recovery());
}

TEST_P(BackendContract, SparsePartIsExactlyZeroWhereNothingWasTaken) {
  const test::Planted planted = test::planted({.rows = 60, .columns = 40, .rank = 3});

  const Solution s = solve(test::batch_of({planted.data()}));

  const Index zeros = (Matrix(s.sparse.segment(0)).array() == 0).count();
  EXPECT_GE(zeros, 60 * 40 * 9 / 10);
  EXPECT_LT(zeros, 60 * 40);
}

TEST_P(BackendContract, ResultsDoNotDependOnPackingOrNeighbours) {
  const SegmentBatch data = ragged();
  const Solution together = solve(data);

  std::vector<Matrix> reversed;
  for (Index b = data.segments(); b-- > 0;) reversed.push_back(data.segment(b));
  const Solution backwards = solve(test::batch_of(reversed));

  for (Index b = 0; b < data.segments(); ++b) {
    const Solution alone = solve(test::batch_of({Matrix(data.segment(b))}));
    const Matrix a = together.low_rank.segment(b), e = together.sparse.segment(b);
    EXPECT_TRUE(test::same_bits(a, Matrix(alone.low_rank.segment(0))));
    EXPECT_TRUE(test::same_bits(e, Matrix(alone.sparse.segment(0))));
    EXPECT_TRUE(test::same_bits(a, backwards.low_rank.segment(data.segments() - 1 - b)));
  }
}

TEST_P(BackendContract, KeepsThePaddingZero) {
  const Solution s = solve(ragged());

  for (const SegmentBatch* part : {&s.low_rank, &s.sparse}) {
    const Eigen::Map<const Matrix> rows(part->storage().data(), part->rows(), part->pitch());
    EXPECT_EQ(rows.rightCols(part->pitch() - part->columns()).cwiseAbs().sum(), 0);
  }
}

TEST_P(BackendContract, ZeroSegmentIsSolvedWithoutAnIteration) {
  const Solution s = solve(test::batch_of({Matrix::Zero(7, 21), test::random_matrix(30, 21, 1)}));

  EXPECT_EQ(s.segments[0].iterations, 0);
  EXPECT_EQ(s.segments[0].rank, 0);
  EXPECT_TRUE(s.segments[0].converged);
  EXPECT_EQ(s.low_rank.segment(0).norm(), 0);
  EXPECT_EQ(s.sparse.segment(0).norm(), 0);
  EXPECT_GT(s.segments[1].iterations, 0);
}

TEST_P(BackendContract, StopsAtTheIterationLimitAndSaysSo) {
  method_.max_iterations = 3;

  const Solution s = solve(ragged());

  for (const SegmentOutcome& outcome : s.segments) {
    EXPECT_EQ(outcome.iterations, 3);
    EXPECT_FALSE(outcome.converged);
    EXPECT_GT(outcome.residual, method_.tolerance);
  }
}

TEST_P(BackendContract, RefusesWhatIsNotFiniteWithItsPlace) {
  SegmentBatch data = ragged();
  data.segment(1)(4, 20) = std::numeric_limits<double>::infinity();

  try {
    solve(data);
    FAIL() << "accepted infinity";
  } catch (const ShapeError& error) {
    EXPECT_THAT(error.what(), HasSubstr("segment 1"));
    EXPECT_THAT(error.what(), HasSubstr("row 4, column 20"));
  }
}

TEST_P(BackendContract, RefusesParametersOutOfRange) {
  method_.rho = 1;

  EXPECT_THROW(solve(ragged()), ArgumentError);
}

TEST_P(BackendContract, ReportsEverySegmentOnce) {
  Monitor monitor;
  std::vector<Progress> reports;
  monitor.report = [&](const Progress& progress) { reports.push_back(progress); };

  backend_->solve(ragged(), method_, monitor);

  ASSERT_FALSE(reports.empty());
  for (std::size_t i = 1; i < reports.size(); ++i)
    EXPECT_GT(reports[i].finished, reports[i - 1].finished);
  EXPECT_EQ(reports.back().finished, 4);
  EXPECT_EQ(reports.back().total, 4);
}

TEST_P(BackendContract, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();

  EXPECT_THROW(backend_->solve(ragged(), method_, {.report = {}, .stop = stop.get_token()}),
               Cancelled);
}

INSTANTIATE_TEST_SUITE_P(
    Backends, BackendContract,
    testing::Combine(testing::Values(BackendKind::reference, BackendKind::reference_two_jobs,
                                     BackendKind::opencl_cpu, BackendKind::opencl_clblast,
                                     BackendKind::opencl_gpu128),
                     testing::Values(UpdateOrder::ae, UpdateOrder::ea)),
    [](const auto& parameter) {
      return to_string(std::get<0>(parameter.param)) + "_" +
             to_string(std::get<1>(parameter.param));
    });

}  // namespace
}  // namespace moclean
