// Iterations followed on paper. For a diagonal D every matrix of the iteration stays diagonal and
// singular value thresholding acts on the diagonal entries, so that two columns of numbers tell it
// all. Each known mistake of public ports changes one of these numbers.
#include <gtest/gtest.h>

#include "moclean/methods/robust_pca/reference.hpp"

#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean::reference {
namespace {

struct Step {
  Eigen::Vector2d A, E, R, Y;  // diagonals; R = D - A - E
  int rank;
};

Matrix diagonal(double first, double second) { return Matrix{{first, 0}, {0, second}}; }

RobustPcaSolution after(int iterations, const Matrix& data, RobustPca method) {
  method.max_iterations = iterations;
  return solve(data, method);
}

void expect_steps(const Matrix& data, const RobustPca& method, const std::vector<Step>& steps) {
  const double bound = test::tolerance::by_hand(8);  // no intermediate entry exceeds 8
  for (std::size_t k = 0; k < steps.size(); ++k) {
    SCOPED_TRACE("iteration " + std::to_string(k + 1));
    const RobustPcaSolution s = after(static_cast<int>(k) + 1, data, method);
    const auto matrix = [](const Eigen::Vector2d& d) { return diagonal(d(0), d(1)); };
    EXPECT_LE(test::largest_difference(s.low_rank, matrix(steps[k].A)), bound) << s.low_rank;
    EXPECT_LE(test::largest_difference(s.sparse, matrix(steps[k].E)), bound) << s.sparse;
    EXPECT_LE(test::largest_difference(s.multipliers, matrix(steps[k].Y)), bound) << s.multipliers;
    EXPECT_NEAR(s.outcome.residual, steps[k].R.norm() / data.norm(), bound);
    EXPECT_EQ(s.outcome.rank, steps[k].rank);
    EXPECT_EQ(s.outcome.iterations, static_cast<int>(k) + 1);
  }
}

// D = diag(3, 1.25), |D|_2 = 3, max|D_ij| / lambda = 4: Y_0 = D / 4, mu = 0.25, 0.5, 1.
const Matrix small = diagonal(3, 1.25);
const RobustPca small_method{.lambda = 0.75, .rho = 2, .mu0_factor = 0.75};

TEST(RobustPcaTrace, FollowsThePapersOrder) {
  // mu = 0.25: X = D + 4 Y = (6, 2.5), less 4; T = D - A + 4 Y = (4, 2.5), less 3.
  // mu = 0.5:  X = D - E + 2 Y = (3.5, 2.5), less 2; T = (3, 2), less 1.5.
  // mu = 1:    X = (2.25, 1.5), less 1; T = (2.5, 1.5), less 0.75.
  expect_steps(small, small_method,
               {{{2, 0}, {1, 0}, {0, 1.25}, {0.75, 0.625}, 1},
                {{1.5, 0.5}, {1.5, 0.5}, {0, 0.25}, {0.75, 0.75}, 2},
                {{1.25, 0.5}, {1.75, 0.75}, {0, 0}, {0.75, 0.75}, 2}});
}

TEST(RobustPcaTrace, FollowsTheOrderOfTheAuthorsCode) {
  // The same start, E first: no singular value survives in any of the three iterations.
  RobustPca method = small_method;
  method.order = UpdateOrder::ea;

  expect_steps(small, method,
               {{{0, 0}, {3, 0}, {0, 1.25}, {0.75, 0.625}, 0},
                {{0, 0}, {3, 1}, {0, 0.25}, {0.75, 0.75}, 0},
                {{0, 0}, {3, 1.25}, {0, 0}, {0.75, 0.75}, 0}});
}

TEST(RobustPcaTrace, FollowsTheOrderOfTheAuthorsCodeWithSurvivingValues) {
  // D = diag(4, 0.75), |D|_2 = 4 > 4 / 1.25: Y_0 = D / 4, mu = 0.25, 0.5, 1.
  // mu = 0.25: T = D + 4 Y = (8, 1.5), less 5; X = D - E + 4 Y = (5, 1.5), less 4.
  // mu = 0.5:  T = D - A + 2 Y = (5, 1.5), less 2.5; X = (3.5, 1.5), less 2.
  // mu = 1:    T = (3.5, 1.5), less 1.25; X = (2.75, 1.25), less 1.
  const RobustPca method{.lambda = 1.25, .rho = 2, .mu0_factor = 1, .order = UpdateOrder::ea};

  expect_steps(diagonal(4, 0.75), method,
               {{{1, 0}, {3, 0}, {0, 0.75}, {1, 0.375}, 1},
                {{1.5, 0}, {2.5, 0}, {0, 0.75}, {1, 0.75}, 1},
                {{1.75, 0.25}, {2.25, 0.25}, {0, 0.25}, {1, 1}, 2}});
}

TEST(RobustPcaTrace, KeepsMuBelowItsLimit) {
  // mu stays 0.25. Second iteration: X = D - E + 4 Y = (5, 3.75), less 4; T = (5, 3.75), less 3.
  RobustPca method = small_method;
  method.mu_max_factor = 1;

  expect_steps(small, method,
               {{{2, 0}, {1, 0}, {0, 1.25}, {0.75, 0.625}, 1},
                {{1, 0}, {2, 0.75}, {0, 0.5}, {0.75, 0.75}, 1}});
}

TEST(RobustPcaTrace, StopsAtTheFirstIterationWithinTolerance) {
  const RobustPcaSolution s = solve(small, small_method);

  EXPECT_EQ(s.outcome.iterations, 3);
  EXPECT_TRUE(s.outcome.converged);
}

TEST(RobustPcaTrace, ReportsAMissedToleranceAndKeepsTheLastIterate) {
  const RobustPcaSolution s = after(2, small, small_method);

  EXPECT_FALSE(s.outcome.converged);
  EXPECT_EQ(s.outcome.iterations, 2);
  EXPECT_NEAR(s.sparse(1, 1), 0.5, test::tolerance::by_hand(4));
}

// One entry d, lambda = 2, mu0_factor 1: Y_0 = 1, mu_0 = 1/d. X = d + Y/mu = 2d, A = X - 1/mu = d.
TEST(RobustPcaMistakes, SubtractingTheMultipliersWouldLeaveNothing) {
  const auto s = after(1, Matrix{{8}}, {.lambda = 2, .mu0_factor = 1});  // else X = 8 - 8

  EXPECT_NEAR(s.low_rank(0, 0), 8, test::tolerance::by_hand(16));
}

TEST(RobustPcaMistakes, ThresholdingByMuWouldTakeAwayTooLittle) {
  const auto s = after(1, Matrix{{8}}, {.lambda = 2, .mu0_factor = 0.5});  // mu = 1/16, X = 24

  EXPECT_NEAR(s.low_rank(0, 0), 8, test::tolerance::by_hand(24));  // 24 - 16, not 24 - 1/16
}

// All entries 1: |D|_2 = 2, max|D_ij| / lambda = 2, so Y_0 = D / 2. With the largest row sum in
// place of the largest entry Y_0 were D / 4 and A = D / 2.
TEST(RobustPcaMistakes, ScalingTheStartByRowSumsWouldHalveTheFirstIterate) {
  const auto s = after(1, Matrix{{1, 1}, {1, 1}}, {.lambda = 0.5, .mu0_factor = 1});

  EXPECT_LE(test::largest_difference(s.low_rank, Matrix{{1, 1}, {1, 1}}),
            test::tolerance::by_hand(4));
}

// lambda = 0.5: Y_0 = 1/2, mu = 1/8: X = 8 + 4, less 8. With mu grown to 1/4 first: 8 + 2 - 4 = 6.
TEST(RobustPcaMistakes, GrowingMuBeforeItsFirstUseWouldKeepMore) {
  const auto s = after(1, Matrix{{8}}, {.lambda = 0.5, .rho = 2, .mu0_factor = 1});

  EXPECT_NEAR(s.low_rank(0, 0), 4, test::tolerance::by_hand(12));
}

// mu = 0.1 / 8: the threshold 80 exceeds X = 8 + 40 in the first iteration; later ones recover.
TEST(RobustPcaMistakes, NoSurvivingSingularValueGivesZeroAndGoesOn) {
  const RobustPca method{.lambda = 0.5, .mu0_factor = 0.1};

  const auto first = after(1, Matrix{{8}}, method);
  const auto last = solve(Matrix{{8}}, method);

  EXPECT_EQ(first.low_rank(0, 0), 0);
  EXPECT_EQ(first.outcome.rank, 0);
  EXPECT_TRUE(last.outcome.converged);
}

}  // namespace
}  // namespace moclean::reference
