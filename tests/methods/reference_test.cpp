#include "moclean/methods/robust_pca/reference.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/decompositions.hpp"
#include "support/matrix.hpp"
#include "support/planted.hpp"
#include "support/tolerance.hpp"

namespace moclean::reference {
namespace {

using test::planted;
using test::relative_difference;
using test::singular_values;

class RobustPcaInBothOrders : public testing::TestWithParam<UpdateOrder> {
 protected:
  RobustPca method() const { return {.order = GetParam()}; }
};

INSTANTIATE_TEST_SUITE_P(Orders, RobustPcaInBothOrders,
                         testing::Values(UpdateOrder::ae, UpdateOrder::ea),
                         [](const auto& order) { return to_string(order.param); });

TEST_P(RobustPcaInBothOrders, RecoversAPlantedProblem) {
  const test::Planted problem = planted({.rows = 60, .columns = 40, .rank = 3});

  const RobustPcaSolution s = solve(problem.data(), method());

  EXPECT_LE(relative_difference(s.low_rank, problem.low_rank), test::tolerance::recovery());
  EXPECT_LE(relative_difference(s.sparse, problem.sparse), test::tolerance::recovery());
  EXPECT_EQ(s.outcome.rank, 3);
  EXPECT_TRUE(s.outcome.converged);
}

TEST_P(RobustPcaInBothOrders, RecoversAWidePlantedProblem) {
  const test::Planted problem = planted({.rows = 40, .columns = 70, .rank = 2, .seed = 5});

  const RobustPcaSolution s = solve(problem.data(), method());

  EXPECT_LE(relative_difference(s.low_rank, problem.low_rank), test::tolerance::recovery());
  EXPECT_LE(relative_difference(s.sparse, problem.sparse), test::tolerance::recovery());
}

TEST_P(RobustPcaInBothOrders, ReportsTheResidualOfWhatItReturns) {
  const Matrix data = planted({}).data();

  const RobustPcaSolution s = solve(data, method());

  const double residual = (data - s.low_rank - s.sparse).norm() / data.norm();
  EXPECT_NEAR(s.outcome.residual, residual, test::tolerance::by_hand(1));
  EXPECT_LE(residual, method().tolerance);
}

// Any Y with |Y|_2 <= 1 and |Y_ij| <= lambda proves |A|_* + lambda |E|_1 >= <D, Y> for every
// decomposition of D. Scaled to be feasible, the multipliers have to close the gap, on a problem
// too noisy for exact recovery.
TEST_P(RobustPcaInBothOrders, IsOptimalByItsDualSolution) {
  const Matrix data = planted({.rank = 8, .error_share = 0.2}).data();
  const double lambda = 1 / std::sqrt(60.0);

  const RobustPcaSolution s = solve(data, {.rho = 1.02, .order = GetParam()});

  const double primal = singular_values(s.low_rank).sum() + lambda * s.sparse.cwiseAbs().sum();
  const double excess = std::max(
      {1.0, singular_values(s.multipliers)(0), s.multipliers.cwiseAbs().maxCoeff() / lambda});
  const double dual = data.cwiseProduct(s.multipliers).sum() / excess;
  EXPECT_NEAR(dual / primal, 1, test::tolerance::duality_gap());
}

TEST_P(RobustPcaInBothOrders, ScalesWithPowersOfTwoBitForBit) {
  const Matrix data = planted({}).data();
  const RobustPcaSolution s = solve(data, method());

  for (const double scale : {0x1p-40, 0.5, 0x1p40}) {
    const RobustPcaSolution scaled = solve(scale * data, method());

    EXPECT_TRUE(test::same_bits(scaled.low_rank, scale * s.low_rank)) << scale;
    EXPECT_TRUE(test::same_bits(scaled.sparse, scale * s.sparse)) << scale;
    EXPECT_EQ(scaled.outcome.iterations, s.outcome.iterations);
  }
}

TEST_P(RobustPcaInBothOrders, ScalesWithTinyAndHugeUnits) {
  const Matrix data = planted({}).data();
  const RobustPcaSolution s = solve(data, method());

  for (const double scale : {1e-12, 1e12}) {
    const RobustPcaSolution scaled = solve(scale * data, method());

    const double bound = test::tolerance::same_iteration(60);
    EXPECT_LE(relative_difference(scaled.low_rank, scale * s.low_rank), bound) << scale;
    EXPECT_LE(relative_difference(scaled.sparse, scale * s.sparse), bound) << scale;
  }
}

TEST_P(RobustPcaInBothOrders, TransposesWithTheData) {
  const Matrix data = planted({}).data();
  const RobustPcaSolution s = solve(data, method());

  const RobustPcaSolution transposed = solve(data.transpose(), method());

  const double bound = test::tolerance::same_iteration(60);
  EXPECT_LE(relative_difference(transposed.low_rank, s.low_rank.transpose()), bound);
  EXPECT_LE(relative_difference(transposed.sparse, s.sparse.transpose()), bound);
  EXPECT_EQ(transposed.outcome.iterations, s.outcome.iterations);
  EXPECT_EQ(transposed.outcome.rank, s.outcome.rank);
}

TEST_P(RobustPcaInBothOrders, PermutesWithTheFrames) {
  const Matrix data = planted({}).data();
  Eigen::PermutationMatrix<Eigen::Dynamic> shift(60);
  for (int i = 0; i < 60; ++i) shift.indices()(i) = (7 * i + 3) % 60;
  const RobustPcaSolution s = solve(data, method());

  const RobustPcaSolution permuted = solve(shift * data, method());

  const double bound = test::tolerance::same_iteration(60);
  EXPECT_LE(relative_difference(permuted.low_rank, shift * s.low_rank), bound);
  EXPECT_LE(relative_difference(permuted.sparse, shift * s.sparse), bound);
}

TEST_P(RobustPcaInBothOrders, FlipsWithTheSignOfTheData) {
  const Matrix data = planted({}).data();

  const RobustPcaSolution s = solve(data, method());
  const RobustPcaSolution flipped = solve(-data, method());

  const double bound = test::tolerance::same_iteration(60);
  EXPECT_LE(relative_difference(flipped.low_rank, -s.low_rank), bound);
  EXPECT_LE(relative_difference(flipped.sparse, -s.sparse), bound);
}

}  // namespace
}  // namespace moclean::reference
