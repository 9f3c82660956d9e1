// Robust PCA with a second-difference penalty: the reference by its properties, and the rule for
// gamma. Device and reference are compared in other_methods_test.cpp.
#include "moclean/methods/temporal_robust_pca/temporal_robust_pca.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"
#include "moclean/methods/temporal_robust_pca/reference.hpp"
#include "moclean/solve/missing.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using reference::solve;
using test::nan;

// A walk, and the same with a third of its frames spoilt as in the paper (Peng et al., equation 7).
struct Spoilt {
  Matrix truth, data;
};

Spoilt spoilt_walk(Index frames) {
  const Matrix truth = test::synthetic_walk(frames).samples.leftCols(30);
  Spoilt walk{truth, truth};
  Random random(1);
  for (Index i = 0; i < frames; ++i) {
    if (random.uniform() > 1.0 / 3) continue;
    for (Index j = 0; j < truth.cols(); ++j)
      if (random.uniform() < 0.5) walk.data(i, j) += 1 + 1.2 * random.normal();
  }
  return walk;
}

double distance(const Matrix& a, const Matrix& b) {
  return (a - b).norm() / std::sqrt(static_cast<double>(a.size()));
}

TEST(TemporalRobustPca, TakesTheNoiseOfThePaperAway) {
  const Spoilt walk = spoilt_walk(200);

  const auto s = solve(walk.data, TemporalRobustPca{});

  EXPECT_TRUE(s.outcome.converged);
  EXPECT_LT(distance(s.low_rank, walk.truth), distance(walk.data, walk.truth) / 20);
}

TEST(TemporalRobustPca, FillsGaps) {
  Spoilt walk = spoilt_walk(200);
  walk.data.block(60, 3, 12, 6).setConstant(nan);

  const auto s = solve(walk.data, TemporalRobustPca{});

  EXPECT_LT(distance(s.low_rank, walk.truth), 0.05);
  EXPECT_EQ(s.sparse.block(60, 3, 12, 6).norm(), 0);
  EXPECT_EQ(s.multipliers.block(60, 3, 12, 6).norm(), 0);
}

// The gradient of the augmented problem at its solution: gamma Delta'Delta S = Y + U with
// |Y_ij| <= lambda, Y_ij = lambda sign(E_ij) where E is not zero, -U in nu times the
// subdifferential of the nuclear norm. A wrong sign of Y or U, or mu in the place of 1/mu, breaks
// one of these.
TEST(TemporalRobustPca, MultipliersAreASubgradientOfTheSparsePart) {
  const Spoilt walk = spoilt_walk(120);
  const TemporalRobustPca method{};

  const auto s = solve(walk.data, method);

  const double lambda = start_temporal(walk.data, method).lambda;
  EXPECT_LE(s.multipliers.cwiseAbs().maxCoeff(), lambda);
  Index errors = 0;
  for (Index i = 0; i < s.sparse.size(); ++i) {
    const double e = s.sparse.data()[i];
    if (std::abs(e) < 1e-12) continue;
    EXPECT_EQ(s.multipliers.data()[i], e > 0 ? lambda : -lambda);
    ++errors;
  }
  EXPECT_GT(errors, walk.data.size() / 10);
}

// One iteration from zero multipliers with nothing to shrink: L of a matrix of rank one, by hand.
TEST(TemporalRobustPca, FirstIterationIsThatOfAPaperCalculation) {
  // Constant columns: Delta D = 0, so S = D. |D|_2 = 4 sqrt(3), mu = 1.25 / |D|_2, and
  // L = (1 - nu |D|_2 / (1.25 |D|_2)) D = 0.76 D; E = 0 as mu (D - S) = 0.
  const Matrix data = Matrix::Constant(4, 3, 2);

  const auto s = solve(data, TemporalRobustPca{.gamma = 1, .max_iterations = 1});

  EXPECT_LE((s.low_rank - data).norm(), test::tolerance::by_hand(10));
  EXPECT_LE(s.sparse.norm(), test::tolerance::by_hand(1));
  EXPECT_EQ(s.outcome.rank, 1);
  EXPECT_NEAR(s.outcome.residual, 0.24, test::tolerance::by_hand(10));
}

// The threshold is nu/mu, not mu: with a large nu no singular value survives the first iteration.
TEST(TemporalRobustPca, NoSingularValueSurvivesADearLowRankPart) {
  const auto s =
      solve(Matrix::Constant(4, 3, 2), TemporalRobustPca{.gamma = 1, .nu = 2, .max_iterations = 1});

  EXPECT_EQ(s.outcome.rank, 0);
  EXPECT_NEAR(s.outcome.residual, 1, test::tolerance::by_hand(1));
}

TEST(TemporalRobustPca, ScalesWithItsData) {
  Spoilt walk = spoilt_walk(120);
  walk.data.block(60, 3, 12, 6).setConstant(nan);
  const auto s = solve(walk.data, TemporalRobustPca{});

  for (const double factor : {1e-3, 1e3}) {
    const auto scaled = solve(factor * walk.data, TemporalRobustPca{});
    EXPECT_EQ(scaled.outcome.iterations, s.outcome.iterations);
    EXPECT_LE(test::relative_difference(scaled.low_rank, factor * s.low_rank),
              test::tolerance::same_iteration(120));
  }
}

TEST(TemporalRobustPca, SolvesSegmentsOfAFewFrames) {
  for (const Index frames : {1, 2, 3, 4, 17, 32}) {
    const Spoilt walk = spoilt_walk(frames);

    const auto s = solve(walk.data, TemporalRobustPca{});

    EXPECT_TRUE(s.outcome.converged) << frames;
    EXPECT_TRUE(s.low_rank.allFinite()) << frames;
  }
}

TEST(PenaltyOf, IsThatOfItsFormulaForANoiseFreeParabola) {
  // x = t^2: second differences 2, over eight frames 128 = 64 * 2, fourth differences 0.
  Matrix data(100, 1);
  for (Index i = 0; i < 100; ++i) data(i, 0) = static_cast<double>(i * i);
  const double s = 2 / 0.318639;

  EXPECT_NEAR(penalty_of(data, 0.1), 0.1 / s, test::tolerance::by_hand(1));
}

TEST(PenaltyOf, HardlyMovesWithOutliersAndGaps) {
  const Spoilt walk = spoilt_walk(400);
  Matrix holey = walk.truth;
  holey.block(50, 0, 80, 10).setConstant(nan);
  const double clean = penalty_of(walk.truth, 0.05);

  EXPECT_NEAR(penalty_of(holey, 0.05), clean, 0.3 * clean);
  EXPECT_GT(penalty_of(walk.data, 0.05), clean / 4);
  EXPECT_LT(penalty_of(walk.data, 0.05), clean * 4);
}

TEST(PenaltyOf, IsFiniteWithoutMotion) {
  EXPECT_TRUE(std::isfinite(penalty_of(Matrix::Constant(50, 3, 7), 0.1)));
  EXPECT_EQ(penalty_of(Matrix::Zero(50, 3), 0.1), 0);
  EXPECT_EQ(penalty_of(Matrix::Constant(50, 3, nan), 0.1), 0);
  EXPECT_TRUE(std::isfinite(penalty_of(Matrix::Constant(1, 3, 7), 0.1)));
}

TEST(TemporalRobustPca, RefusesParametersOutOfRange) {
  EXPECT_THROW(check(TemporalRobustPca{.gamma = -1}), ArgumentError);
  EXPECT_THROW(check(TemporalRobustPca{.nu = 0}), ArgumentError);
  EXPECT_THROW(check(TemporalRobustPca{.lambda = nan}), ArgumentError);
  EXPECT_THROW(check(TemporalRobustPca{.rho = 1}), ArgumentError);
  EXPECT_THROW(check(TemporalRobustPca{.tolerance = 0}), ArgumentError);
  EXPECT_THROW(check(TemporalRobustPca{.max_iterations = 0}), ArgumentError);
}

}  // namespace
}  // namespace moclean
