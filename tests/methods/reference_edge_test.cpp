// Segments at the edge of the method: each has one answer that follows on paper.
#include <gtest/gtest.h>

#include "moclean/methods/robust_pca/reference.hpp"

#include "support/matrix.hpp"
#include "support/planted.hpp"
#include "support/tolerance.hpp"

namespace moclean::reference {
namespace {

// While |D|_2 >= max|D_ij| / lambda, a rank-one D is its own low-rank part after one iteration:
// X = D + Y/mu = 1.8 D, less 0.8 |D|_2.
void expect_kept_whole(const Matrix& data) {
  const RobustPcaSolution s = solve(data, {});

  const double bound = test::tolerance::decomposition(std::max(data.rows(), data.cols()));
  EXPECT_LE(test::relative_difference(s.low_rank, data), bound);
  EXPECT_TRUE(s.sparse.isZero(0)) << s.sparse.cwiseAbs().maxCoeff();
  EXPECT_EQ(s.outcome.rank, 1);
  EXPECT_EQ(s.outcome.iterations, 1);
  EXPECT_TRUE(s.outcome.converged);
}

TEST(RobustPcaEdge, KeepsAConstantSegment) { expect_kept_whole(Matrix::Constant(60, 40, -2.5)); }

TEST(RobustPcaEdge, KeepsConstantColumns) {
  const Matrix row = test::random_matrix(1, 40, 1);
  expect_kept_whole(Matrix::Ones(60, 1) * row);
}

TEST(RobustPcaEdge, KeepsARankOneSegmentOfTwoSigns) {
  const Matrix signs = Matrix::NullaryExpr(60, 1, [](Index i, Index) { return i % 3 ? 1. : -1.; });
  expect_kept_whole(signs * Matrix::Constant(1, 40, 3));
}

TEST(RobustPcaEdge, KeepsRankOneWithMoreColumnsThanFrames) {
  expect_kept_whole(Matrix::Constant(25, 93, 7));
}

TEST(RobustPcaEdge, SplitsAZeroSegmentIntoZerosWithoutIterating) {
  const RobustPcaSolution s = solve(Matrix::Zero(5, 3), {});

  EXPECT_TRUE(test::same_bits(s.low_rank, Matrix::Zero(5, 3)));
  EXPECT_TRUE(test::same_bits(s.sparse, Matrix::Zero(5, 3)));
  EXPECT_EQ(s.outcome.iterations, 0);
  EXPECT_EQ(s.outcome.rank, 0);
  EXPECT_EQ(s.outcome.residual, 0);
  EXPECT_TRUE(s.outcome.converged);
}

// One entry with lambda = 1: Y = 1, X = 1.8 d less 0.8 d.
TEST(RobustPcaEdge, KeepsASingleEntry) {
  for (const double d : {4.0, -4.0, 1e-12, 1e12}) expect_kept_whole(Matrix::Constant(1, 1, d));
}

// Frames of one column: |A|_* is |D|_2 and lambda |E|_1 at least |D|_1 / sqrt(frames) <= |D|_2, so
// unless all entries are equal in size it pays to call a large entry an error.
TEST(RobustPcaEdge, SolvesOneColumnAndOneFrameAlike) {
  const Matrix column = test::random_matrix(30, 1, 4);

  const RobustPcaSolution tall = solve(column, {});
  const RobustPcaSolution flat = solve(column.transpose(), {});

  EXPECT_TRUE(tall.outcome.converged);
  EXPECT_EQ(tall.outcome.iterations, flat.outcome.iterations);
  EXPECT_EQ(tall.outcome.rank, flat.outcome.rank);
  EXPECT_LE((tall.low_rank - flat.low_rank.transpose()).norm(),
            test::tolerance::same_iteration(30) * column.norm());
  EXPECT_LE((tall.low_rank + tall.sparse - column).norm(), 1e-7 * column.norm());
}

Matrix lone_entry(double d) {
  Matrix data = Matrix::Zero(64, 40);
  data(17, 5) = d;
  return data;
}

// lambda = 1/8, Y = lambda D / d, 1/mu = 0.8 d. E first: T = (1 + 0.8 lambda) d, less 0.8 lambda d,
// is all of D; of X = 0.8 lambda d nothing survives. This is the optimum: |D|_* = d, lambda |D|_1 =
// d / 8.
TEST(RobustPcaEdge, CallsALoneEntryAnErrorInTheOrderOfTheAuthorsCode) {
  const RobustPcaSolution s = solve(lone_entry(3), {.order = UpdateOrder::ea});

  EXPECT_EQ(s.outcome.rank, 0);
  EXPECT_EQ(s.outcome.iterations, 1);
  EXPECT_TRUE(s.low_rank.isZero(0));
  EXPECT_LE(test::largest_difference(s.sparse, lone_entry(3)), test::tolerance::by_hand(3));
}

// A first: X = (1 + 0.8 lambda) d, less 0.8 d, leaves A = 0.3 d; T = 0.8 d, less 0.8 lambda d,
// leaves E = 0.7 d. Together they are D, and the test of feasibility stops the paper's order right
// there.
TEST(RobustPcaEdge, SplitsALoneEntryInThePapersOrder) {
  const RobustPcaSolution s = solve(lone_entry(3), {.order = UpdateOrder::ae});

  EXPECT_EQ(s.outcome.rank, 1);
  EXPECT_EQ(s.outcome.iterations, 1);
  EXPECT_LE(test::largest_difference(s.low_rank, lone_entry(0.9)), test::tolerance::by_hand(3));
  EXPECT_LE(test::largest_difference(s.sparse, lone_entry(2.1)), test::tolerance::by_hand(3));
}

TEST(RobustPcaEdge, LeavesASmallLambdaNoLowRankPart) {
  const Matrix data = test::planted({}).data();

  const RobustPcaSolution s = solve(data, {.lambda = 1e-3});

  EXPECT_EQ(s.outcome.rank, 0);
  EXPECT_TRUE(s.low_rank.isZero(0));
  EXPECT_LE(test::relative_difference(s.sparse, data), RobustPca{}.tolerance);
}

TEST(RobustPcaEdge, LeavesALargeLambdaNoSparsePart) {
  const Matrix data = test::planted({}).data();

  const RobustPcaSolution s = solve(data, {.lambda = 10});

  EXPECT_TRUE(s.sparse.isZero(0));
  EXPECT_LE(test::relative_difference(s.low_rank, data), RobustPca{}.tolerance);
  EXPECT_EQ(s.outcome.rank, 40);
}

TEST(RobustPcaEdge, KeepsDataThatIsAlreadyOfLowRank) {
  const Matrix data = test::planted({.rank = 2, .error_share = 0}).data();

  const RobustPcaSolution s = solve(data, {});

  EXPECT_LE(test::relative_difference(s.low_rank, data), test::tolerance::recovery());
  EXPECT_LE(s.sparse.norm(), test::tolerance::recovery() * data.norm());
  EXPECT_EQ(s.outcome.rank, 2);
}

}  // namespace
}  // namespace moclean::reference
