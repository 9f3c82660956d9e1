#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"
#include "moclean/methods/matrix_completion/reference.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;

TEST(StartCompletion, IsThatOfTheAlgorithmOnPaper) {
  const Matrix data{{3, nan}, {0, 4}};

  const CompletionStart start = start_completion(data, {.threshold = 2, .step = 1.2});

  EXPECT_EQ(start.data, (Matrix{{3, 0}, {0, 4}}));
  EXPECT_EQ(start.observed, (Matrix{{1, 0}, {1, 1}}));
  EXPECT_EQ(start.norm, 5);
  EXPECT_EQ(start.tau, 10);
  EXPECT_NEAR(start.delta, 1.2 * 4 / 3, test::tolerance::by_hand(2));
  EXPECT_NEAR(start.kick(4), 2 * 1.6, test::tolerance::by_hand(4));  // ceil(10 / 6.4) = 2
}

// One entry of size 2: tau = 2, delta = 1, Y = ceil(2 / 2) 2 = 2. X = 0, Y = 4; X = 2.
TEST(MatrixCompletion, FollowsTheIterationOnPaper) {
  const MatrixCompletion method{.threshold = 1, .step = 1};

  const auto solution = reference::solve(Matrix{{2}}, method);
  const auto stopped =
      reference::solve(Matrix{{2}}, {.threshold = 1, .step = 1, .max_iterations = 1});

  EXPECT_EQ(solution.outcome.iterations, 2);
  EXPECT_TRUE(solution.outcome.converged);
  EXPECT_NEAR(solution.low_rank(0, 0), 2, test::tolerance::by_hand(2));
  EXPECT_EQ(stopped.low_rank(0, 0), 0);
  EXPECT_EQ(stopped.sparse(0, 0), 2);
  EXPECT_EQ(stopped.outcome.residual, 1);
  EXPECT_FALSE(stopped.outcome.converged);
}

TEST(MatrixCompletion, RecoversALowRankMatrixFromPartOfIt) {
  const Matrix whole = test::random_matrix(60, 2, 1) * test::random_matrix(2, 40, 2);
  Matrix seen = whole;
  Random random(3);
  for (double& entry : seen.reshaped())
    if (random.uniform() < 0.3) entry = nan;

  const auto solution = reference::solve(seen, {.threshold = 5, .tolerance = 1e-4});

  EXPECT_TRUE(solution.outcome.converged);
  EXPECT_EQ(solution.outcome.rank, 2);
  EXPECT_LE(test::relative_difference(solution.low_rank, whole), test::tolerance::completion());
}

TEST(MatrixCompletion, SplitsWhatWasObserved) {
  Matrix seen = test::random_matrix(20, 3, 1) * test::random_matrix(3, 12, 2);
  seen(4, 5) = nan;

  const auto solution = reference::solve(seen, {});

  EXPECT_EQ(solution.sparse(4, 5), 0);
  EXPECT_TRUE(std::isfinite(solution.low_rank(4, 5)));
  Matrix sum = solution.low_rank + solution.sparse;
  sum(4, 5) = seen(4, 5) = 0;
  EXPECT_LE(test::largest_difference(sum, seen), test::tolerance::by_hand(10));
  EXPECT_NEAR(solution.outcome.residual, solution.sparse.norm() / seen.norm(),
              test::tolerance::by_hand(1));
}

TEST(MatrixCompletion, StepsThatLetTheResidualGrowAreShortened) {
  EXPECT_EQ(next_step(5, 0.5, 1), 5);
  EXPECT_EQ(next_step(5, 1.1, 1), 1.9);
  EXPECT_EQ(next_step(1.2, 1.1, 1), 1.2);
}

// delta is 648, 64 and 2.4: with it Y grows beyond all numbers, or swings for ever.
TEST(MatrixCompletion, ConvergesHoweverLittleIsSeen) {
  const Matrix whole = test::random_matrix(60, 9, 1);
  Matrix one = Matrix::Constant(60, 9, nan), frame = one, chequered = whole;
  one(30, 4) = 5;
  frame.row(0) = whole.row(0);
  for (Index i = 0; i < chequered.size(); i += 2) chequered.data()[i] = nan;

  for (const Matrix& seen : {one, frame, chequered}) {
    const auto solution = reference::solve(seen, {});

    EXPECT_TRUE(solution.outcome.converged);
    EXPECT_TRUE(solution.low_rank.allFinite());
    EXPECT_LE(solution.outcome.residual, MatrixCompletion{}.tolerance);
  }
}

TEST(MatrixCompletion, TakesNoIterationForNothing) {
  for (const Matrix& data : {Matrix(Matrix::Zero(3, 4)), Matrix(Matrix::Constant(3, 4, nan))}) {
    const auto solution = reference::solve(data, {});

    EXPECT_EQ(solution.outcome.iterations, 0);
    EXPECT_TRUE(solution.outcome.converged);
    EXPECT_EQ(solution.low_rank.norm(), 0);
    EXPECT_EQ(solution.sparse.norm(), 0);
  }
}

TEST(MatrixCompletion, RefusesParametersOutOfRange) {
  EXPECT_THROW(check(MatrixCompletion{.threshold = 0}), ArgumentError);
  EXPECT_THROW(check(MatrixCompletion{.step = -1}), ArgumentError);
  EXPECT_THROW(check(MatrixCompletion{.tolerance = nan}), ArgumentError);
  EXPECT_THROW(check(MatrixCompletion{.max_iterations = 0}), ArgumentError);
}

}  // namespace
}  // namespace moclean
