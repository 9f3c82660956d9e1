// The stated deviation of matrix-normal smoothing: its pieces against dense linear algebra.
#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "moclean/methods/matrix_normal/deviation.hpp"
#include "moclean/methods/matrix_normal/window.hpp"

#include "support/matrix.hpp"
#include "support/model_motion.hpp"

namespace moclean {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Eigen::MatrixXd second_differences(Index frames) {
  Eigen::MatrixXd delta = Eigen::MatrixXd::Zero(frames - 2, frames);
  for (Index i = 0; i + 2 < frames; ++i) delta.row(i).segment<3>(i) << 1, -2, 1;
  return delta;
}

// An estimate of motion drawn from the model, every sample in use.
MotionEstimate estimate_of(Index frames, Index columns, std::uint64_t seed) {
  const test::ModelMotion model = test::model_motion(frames, columns, seed);
  return {.motion = model.motion,
          .used = Mask::Constant(frames, columns, true),
          .rejected = Matrix::Zero(frames, columns),
          .prior_variance = Matrix::Constant(frames, columns, infinite),
          .eigenvectors = model.eigenvectors,
          .spectrum = model.spectrum,
          .precision = Eigen::VectorXd::Ones(frames - 2),
          .noise = 0,
          .size = 10,
          .floor = 1e-4,
          .joint_columns = 3};
}

TEST(VarianceLeft, IsTheDiagonalOfTheInverse) {
  for (const Index frames : {3, 4, 60}) {
    const Eigen::VectorXd precision = test::random_matrix(frames - 2, 1, 1).col(0).cwiseAbs2();
    const Eigen::VectorXd confidence =
        test::random_matrix(frames, 1, 2).col(0).cwiseAbs().cwiseMax(0.05);
    const Eigen::MatrixXd delta = second_differences(frames);
    const Eigen::Vector3d ratios(1e-6, 1, 1e4);  // noise over power

    const Matrix left = variance_left(ratios, precision, confidence);

    for (Index k = 0; k < 3; ++k) {
      const Eigen::MatrixXd samples = confidence.asDiagonal();
      const Eigen::MatrixXd posterior =
          (samples + ratios(k) * delta.transpose() * precision.asDiagonal() * delta).inverse();
      EXPECT_LE((left.col(k) - posterior.diagonal()).cwiseAbs().maxCoeff(), 1e-9)
          << frames << " " << k;
    }
  }
}

// Far from the ends, and four times that at them.
TEST(VarianceLeft, IsTheKeptPower) {
  const Eigen::VectorXd ratio = Eigen::VectorXd::Constant(1, 1e5);

  const Matrix left = variance_left(ratio, Eigen::VectorXd::Ones(598), Eigen::VectorXd::Ones(600));

  EXPECT_NEAR(left(300, 0) / kept_power(1e5, 1), 1, 1e-6);
  EXPECT_NEAR(left(0, 0) / kept_power(1e5, 1), 4, 0.2);
}

TEST(ConditionalVariance, IsThatOfTheColumnsNotInUse) {
  const Matrix half = test::random_matrix(9, 9, 1);
  const Matrix Q = half * half.transpose() + Matrix::Identity(9, 9), R = Q.inverse();
  for (const Index unknown : {2, 7, 9}) {  // few, many, all
    Eigen::Array<bool, Eigen::Dynamic, 1> used =
        Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(9, true);
    used.head(unknown).setConstant(false);

    const Eigen::VectorXd variance = conditional_variance(Q, R, used);

    const Eigen::VectorXd expected = R.topLeftCorner(unknown, unknown).inverse().diagonal();
    EXPECT_LE((variance.head(unknown) - expected).norm(), 1e-10 * expected.norm()) << unknown;
    EXPECT_EQ(variance.tail(9 - unknown).norm(), 0) << unknown;
  }
}

TEST(MarginalDeviation, IsTheFloorWithoutNoise) {
  const MotionEstimate e = estimate_of(60, 9, 1);

  EXPECT_LE((marginal_deviation(e).array() / e.floor - 1).abs().maxCoeff(), 1e-12);
}

TEST(MarginalDeviation, HasTheProfileOfThePosteriorUnderNoise) {
  constexpr Index frames = 120, columns = 3;
  MotionEstimate e = estimate_of(frames, columns, 1);
  e.noise = 2;
  const Matrix Q = e.eigenvectors.transpose() * e.spectrum.asDiagonal() * e.eigenvectors;
  const Eigen::MatrixXd R = Q.inverse(), delta = second_differences(frames);
  const Eigen::MatrixXd penalty = delta.transpose() * delta;
  Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(frames * columns, frames * columns) / 4;
  for (Index a = 0; a < columns; ++a)
    for (Index b = 0; b < columns; ++b)
      precision.block(a * frames, b * frames, frames, frames) += R(a, b) * penalty;
  const Eigen::VectorXd posterior = precision.inverse().diagonal();

  const Matrix variance = marginal_deviation(e).cwiseAbs2();

  const double learned = variance(60, 0) / posterior(60);  // one factor throughout
  EXPECT_GE(learned, 1);
  EXPECT_LE(learned, 1.5);  // eight times as many accelerations as columns
  for (Index j = 0; j < columns; ++j)
    for (const Index i : {0, 1, 4, 20, 60, 118, 119})
      EXPECT_NEAR(variance(i, j) / posterior(j * frames + i), learned, 1e-6 * learned) << i;
}

TEST(MarginalDeviation, IsLargerWhereAccelerationsAre) {
  MotionEstimate e = estimate_of(120, 9, 1);
  e.noise = 20;
  const Matrix even = marginal_deviation(e);
  e.precision.segment(60, 5).setConstant(0.01);
  const Matrix uneven = marginal_deviation(e);

  EXPECT_GT(uneven(62, 4), 1.3 * even(62, 4));
  EXPECT_NEAR(uneven(10, 4), even(10, 4), 1e-3 * even(10, 4));
}

TEST(MarginalDeviation, GrowsIntoAGapAndMoreWithoutNeighboursAndFarSide) {
  MotionEstimate e = estimate_of(300, 21, 1);
  e.used.block(100, 3, 21, 3).setConstant(false);
  const Matrix alone = marginal_deviation(e);
  e.used.block(100, 6, 21, 6).setConstant(false);
  const Matrix together = marginal_deviation(e);
  e.used.block(280, 15, 20, 3).setConstant(false);
  const Matrix open = marginal_deviation(e);

  EXPECT_LT(alone(100, 3), alone(104, 3));
  EXPECT_LT(alone(104, 3), alone(110, 3));
  EXPECT_NEAR(alone(105, 3), alone(115, 3), 1e-9 * alone(105, 3));
  EXPECT_GT(together(110, 3), 1.1 * alone(110, 3));
  EXPECT_GT(open(299, 15), 2 * open(290, 15));  // 2.4 = sqrt(40 41^2 / (22 23^2)), less the trials
}

TEST(MarginalDeviation, JoinsWhatElseIsKnownByPrecision) {
  MotionEstimate e = estimate_of(300, 9, 1);
  e.used.block(100, 3, 40, 3).setConstant(false);
  e.floor = 1e-9;
  const double own = marginal_deviation(e)(120, 4);
  e.prior_variance(120, 4) = own * own;

  EXPECT_NEAR(marginal_deviation(e)(120, 4), own / std::sqrt(2.), 1e-6 * own);
}

TEST(MarginalDeviation, IsNotCarriedAwayByAPriorThatKnowsNothing) {
  MotionEstimate e = estimate_of(300, 9, 1);
  e.used.block(100, 3, 40, 3).setConstant(false);
  e.floor = 1e-9;
  const double own = marginal_deviation(e)(120, 4);
  e.prior_variance(120, 4) = 1e12 * own * own;

  EXPECT_LE(marginal_deviation(e)(120, 4), 3.001 * own);
  EXPECT_GE(marginal_deviation(e)(120, 4), own);
}

TEST(MarginalDeviation, DoubtsRejectionsThatTheTailOfTheModelExplains) {
  MotionEstimate e = estimate_of(300, 9, 1);
  e.used.block(100, 3, 1, 3).setConstant(false);
  const double sure = marginal_deviation(e)(100, 4);
  e.rejected(100, 4) = 8 * sure;
  const double doubted = marginal_deviation(e)(100, 4);
  e.rejected(100, 4) = 1e4 * sure;

  EXPECT_GT(doubted, 6 * sure);
  EXPECT_LT(doubted, 8.1 * sure);
  EXPECT_LT(marginal_deviation(e)(100, 4), 8 * sure);
}

}  // namespace
}  // namespace moclean
