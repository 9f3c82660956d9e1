#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/methods/spectral/reference.hpp"

#include "support/matrix.hpp"
#include "support/planted.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Shrink = SingularValueThresholding::Shrink;

// diag(9, 4, 1) between rotations by the 3-4-5 triangle: U D V' with singular values 9, 4, 1.
struct Small {
  Matrix u{{0.6, -0.8, 0}, {0.8, 0.6, 0}, {0, 0, 1}};
  Matrix v{{1, 0, 0}, {0, 0.8, -0.6}, {0, 0.6, 0.8}};

  Matrix with(double a, double b, double c) const {
    return u * Eigen::Vector3d(a, b, c).asDiagonal() * v.transpose();
  }
};

TEST(TruncatedSvd, KeepsTheLargestSingularValues) {
  const Small small;

  const auto solution = reference::solve(small.with(9, 4, 1), TruncatedSvd{.rank = 2});

  EXPECT_LE(test::largest_difference(solution.low_rank, small.with(9, 4, 0)),
            test::tolerance::by_hand(9));
  EXPECT_LE(test::largest_difference(solution.sparse, small.with(0, 0, 1)),
            test::tolerance::by_hand(9));
  EXPECT_EQ(solution.outcome.rank, 2);
  EXPECT_EQ(solution.outcome.iterations, 1);
  EXPECT_TRUE(solution.outcome.converged);
}

TEST(TruncatedSvd, KeepsEverythingWhereThereIsLess) {
  const Matrix data = test::random_matrix(4, 7, 1);

  const auto solution = reference::solve(data, TruncatedSvd{.rank = 10});

  EXPECT_LE(test::relative_difference(solution.low_rank, data), test::tolerance::decomposition(7));
  EXPECT_EQ(solution.outcome.rank, 4);
}

TEST(TruncatedSvd, CountsOnlyWhatIsThere) {
  const Matrix data = test::random_matrix(30, 2, 1) * test::random_matrix(2, 20, 2);

  EXPECT_EQ(reference::solve(data, TruncatedSvd{.rank = 5}).outcome.rank, 2);
  EXPECT_EQ(reference::solve(Matrix::Zero(3, 4), TruncatedSvd{}).outcome.iterations, 0);
}

TEST(SingularValueThresholding, ShrinksOrKeepsWhatIsAboveTheThreshold) {
  const Small small;
  const Matrix data = small.with(9, 4, 1);

  const auto soft = reference::solve(data, SingularValueThresholding{.threshold = 3});
  const auto hard =
      reference::solve(data, SingularValueThresholding{.threshold = 3, .shrink = Shrink::hard});

  EXPECT_LE(test::largest_difference(soft.low_rank, small.with(6, 1, 0)),
            test::tolerance::by_hand(9));
  EXPECT_LE(test::largest_difference(hard.low_rank, small.with(9, 4, 0)),
            test::tolerance::by_hand(9));
  EXPECT_EQ(soft.outcome.rank, 2);
}

// For a square matrix the singular values follow the quarter circle law, whose median 2 sin(theta)
// solves sin(2 theta) + 2 theta = pi/2; with d = cos(d) that is mu = 2 (1 - sin(d)).
TEST(MarchenkoPasturMedian, IsThatOfTheQuarterCircle) {
  constexpr double dottie = 0.7390851332151607;

  EXPECT_NEAR(marchenko_pastur_median(1), 2 * (1 - std::sin(dottie)),
              test::tolerance::simpson_median());
}

// Gavish, Donoho 2014: omega(0.05) 1.5194, omega(0.5) 2.1711, omega(1) 2.8582.
TEST(ThresholdFactor, IsThatOfTheTableOfGavishAndDonoho) {
  for (const auto& [beta, omega] : {std::pair(0.05, 1.5194), {0.5, 2.1711}, {1.0, 2.8582}})
    EXPECT_NEAR(threshold_factor(Shrink::hard, beta), omega, test::tolerance::omega_table())
        << beta;
}

TEST(ThresholdFactor, OfTheSoftThresholdIsTheEdgeOfTheNoise) {
  for (const double beta : {0.1, 0.6, 1.0})
    EXPECT_NEAR(threshold_factor(Shrink::soft, beta) * std::sqrt(marchenko_pastur_median(beta)),
                1 + std::sqrt(beta), test::tolerance::by_hand(2));
}

TEST(SingularValueThresholding, FindsTheRankInWhiteNoise) {
  const Matrix planted = 3 * test::random_matrix(200, 4, 1) * test::random_matrix(4, 90, 2);
  const Matrix noisy = planted + test::random_matrix(200, 90, 3);

  const auto hard = reference::solve(noisy, SingularValueThresholding{.shrink = Shrink::hard});
  const auto soft = reference::solve(noisy, SingularValueThresholding{});

  EXPECT_EQ(hard.outcome.rank, 4);
  EXPECT_EQ(soft.outcome.rank, 4);
  EXPECT_LT((hard.low_rank - planted).norm(), (noisy - planted).norm() / 3);
}

TEST(WeightsOf, AreZeroForWhatIsRounding) {
  const std::vector<double> sigma = {1, 1e-3, 1e-14};

  EXPECT_THAT(weights_of(TruncatedSvd{.rank = 3}, sigma, 9, 3), ElementsAre(1, 1, 0));
  EXPECT_THAT(weights_of(SingularValueThresholding{.threshold = 0.5}, sigma, 9, 3),
              ElementsAre(0.5, 0, 0));
}

TEST(WeightsOf, KeepWhatThereIsWhereTheMedianIsZero) {
  const std::vector<double> sigma = {1, 1e-3, 1e-9, 1e-10};

  EXPECT_THAT(weights_of(SingularValueThresholding{}, sigma, 9, 4), ElementsAre(1, 1, 0, 0));
}

TEST(WeightsOf, NeedAThresholdWhereTheMedianIsNoNoise) {
  const std::vector<double> sigma = {3, 1};

  EXPECT_THAT([&] { weights_of(SingularValueThresholding{}, sigma, 50, 2); },
              ThrowsMessage<ArgumentError>(HasSubstr("svt has no rule for 50 frames x 2 columns")));
}

TEST(SpectralMethods, RefuseParametersOutOfRange) {
  EXPECT_THROW(check(TruncatedSvd{.rank = 0}), ArgumentError);
  EXPECT_THROW(check(SingularValueThresholding{.threshold = -1}), ArgumentError);
  EXPECT_THROW(check(SingularValueThresholding{.threshold = std::nan("")}), ArgumentError);
}

}  // namespace
}  // namespace moclean
