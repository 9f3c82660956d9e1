// The reference of matrix-normal smoothing: its pieces by hand, what it promises, what it is for.
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"
#include "moclean/methods/matrix_normal/on_lengths.hpp"
#include "moclean/methods/matrix_normal/reference.hpp"
#include "moclean/methods/matrix_normal/statistics.hpp"
#include "moclean/methods/matrix_normal/window.hpp"

#include "support/correlated_noise.hpp"
#include "support/matrix.hpp"
#include "support/model_motion.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;

Matrix walk(Index frames, Index columns) {
  return test::synthetic_walk(frames).samples.leftCols(columns);
}

// Every third frame is noisy: entries are off by N(1, 1.2) with probability 1/2.
Matrix spoilt(Matrix motion, std::uint64_t seed) {
  Random random(seed);
  for (Index i = 0; i < motion.rows(); ++i) {
    if (random.uniform() > 1. / 3) continue;
    for (Index j = 0; j < motion.cols(); ++j)
      if (random.uniform() < 0.5) motion(i, j) += 1 + 1.2 * random.normal();
  }
  return motion;
}

// 1 of all second differences.
Eigen::VectorXd precisions(Index rows) {
  Eigen::VectorXd result = Eigen::VectorXd::Ones(rows);
  result.tail(2).setZero();
  return result;
}

double rms(const Matrix& difference) {
  return difference.norm() / std::sqrt(static_cast<double>(difference.size()));
}

TEST(KeptPower, IsTheMeanOverFrequencies) {
  for (const double ratio : {1e-6, 0.01, 1., 50., 1e6}) {
    double mean = 0;
    constexpr int midpoints = 200000;
    for (int i = 0; i < midpoints; ++i) {
      const double w = (i + 0.5) / midpoints * std::numbers::pi;
      mean += 1 / (1 + ratio * std::pow(2 - 2 * std::cos(w), 2)) / midpoints;
    }
    EXPECT_NEAR(kept_power(ratio * 3, 3), mean, 1e-9) << ratio;  // of the quadrature
  }
}

TEST(Stiffness, IsTheSecondDifferenceTwice) {
  Matrix x(4, 1);
  x << 1, 0, 2, 5;  // second differences 3, 1

  Matrix expected(4, 1);
  expected << 3, -5, 1, 1;

  EXPECT_EQ(reference::stiffness(x, precisions(4)), expected);
  EXPECT_EQ(reference::stiffness(Matrix::Ones(2, 3), precisions(2)), Matrix::Zero(2, 3));

  expected << 6, -11, 4, 1;  // 2 times 3 (1, -2, 1, 0) and (0, 1, -2, 1)
  EXPECT_EQ(reference::stiffness(x, Eigen::Vector4d(2, 1, 0, 0)), expected);
}

TEST(Smooth, SolvesItsSystem) {
  constexpr Index m = 12, n = 3;
  const Matrix data = test::random_matrix(m, n, 1);
  const Matrix weights = test::random_matrix(m, n, 2).cwiseAbs();
  const Matrix half = test::random_matrix(n, n, 3);
  const Matrix R = half * half.transpose() + Matrix::Identity(n, n);
  const Eigen::VectorXd precision =
      precisions(m).cwiseProduct(test::random_matrix(m, 1, 4).col(0).cwiseAbs());
  Matrix S = Matrix::Zero(m, n);

  const int taken = reference::smooth(data, weights, precision, R, 500, 1e-14, S);

  const Matrix rest =
      weights.cwiseProduct(S) + reference::stiffness(S, precision) * R - weights.cwiseProduct(data);
  EXPECT_LE(rest.norm(), 1e-10 * weights.cwiseProduct(data).norm());
  EXPECT_LT(taken, 500);
}

TEST(Smooth, TakesOneIterationWhereColumnsAreIndependent) {
  const Matrix data = test::random_matrix(40, 3, 1), weights = Matrix::Ones(40, 3);
  const Matrix R = Eigen::Vector3d(1, 10, 100).asDiagonal().toDenseMatrix();
  Eigen::VectorXd uneven = precisions(40);
  uneven.segment(10, 5).setConstant(0.01);
  for (const Eigen::VectorXd& precision : {precisions(40), uneven}) {
    Matrix S = data;
    EXPECT_EQ(reference::smooth(data, weights, precision, R, 8, 1e-6, S), 1);
  }
}

TEST(Reach, IsTheHarmonicDistanceToSamplesInUse) {
  Matrix weights(5, 1);
  weights << 1, 0, 0, 1, 1;

  const Matrix h = gap_distance(weights);

  EXPECT_DOUBLE_EQ(h(1, 0), 2. * 1 * 2 / 3);  // 1 before, 2 after
  EXPECT_DOUBLE_EQ(h(2, 0), 2. * 2 * 1 / 3);
  EXPECT_DOUBLE_EQ(h(0, 0), 2. * 4 * 3 / 7);  // the end counts as 4 before; 3 after
  EXPECT_DOUBLE_EQ(h(3, 0), 2. * 3 * 1 / 4);
}

TEST(DenseNoise, IsFoundBesideMotionAndOutliers) {
  Matrix data = walk(400, 9);
  Random random(2);
  for (Index i = 0; i < data.size(); ++i) data.data()[i] += 0.1 * random.normal();

  EXPECT_NEAR(dense_noise_level(data), 0.1, 0.01);
  EXPECT_EQ(dense_noise_level(data.topRows(4)), 0);
}

TEST(PutOnLengths, MovesFreeJointsOnly) {
  Matrix positions(1, 6);
  positions << 0, 0, 0, 3, 0, 0;
  const std::vector<DistanceLink> links = {{0, 1, 2, true, true}};
  Mask free(1, 2);
  free << false, true;

  const Mask moved = put_on_lengths(links, free, positions);

  EXPECT_TRUE(moved(0, 1));
  EXPECT_FALSE(moved(0, 0));
  EXPECT_DOUBLE_EQ(positions(0, 0), 0);
  EXPECT_DOUBLE_EQ(positions(0, 3), 2);
}

TEST(MatrixNormal, LeavesCleanMotionAlone) {
  const Matrix motion = walk(300, 12);

  const auto result = reference::solve(motion, MatrixNormal{});

  EXPECT_LE(rms(result.low_rank - motion), 1e-3);
}

TEST(MatrixNormal, TakesTheNoiseOfThePaperAway) {
  const Matrix motion = walk(300, 12), data = spoilt(motion, 1);

  const auto result = reference::solve(data, MatrixNormal{});

  EXPECT_LE(rms(result.low_rank - motion), 0.05 * rms(data - motion));
  const auto wrong = static_cast<double>(((data - motion).array().abs() > 0.5).count());
  const Mask found = (data - motion).array().abs() > 0.5 && result.trusted.array() == 0;
  EXPECT_GE(static_cast<double>(found.count()), 0.99 * wrong);
}

TEST(MatrixNormal, TakesKnownNoiseAwayThatNeighbouringFramesShare) {
  const Matrix truth = walk(600, 30);
  const Matrix noisy = truth + 0.3 * test::correlated_noise(600, 30, 0.9);
  const MatrixNormal unknown{.joint_columns = 1};  // the walk's joints do not move as bodies do
  const MotionPrior known{.noise = 0.3 * std::sqrt(1.9 / 0.1)};

  const double plain = rms(reference::solve(noisy, unknown).low_rank - truth);
  const double informed = rms(reference::solve(noisy, unknown, {}, known).low_rank - truth);

  EXPECT_GE(plain, 0.9 * rms(noisy - truth));  // it looks like motion
  EXPECT_LE(informed, 0.8 * plain);
}

TEST(MatrixNormal, FillsGaps) {
  const Matrix motion = walk(300, 12);
  Matrix data = motion;
  data.block(100, 3, 30, 3).setConstant(nan);

  const auto result = reference::solve(data, MatrixNormal{});

  EXPECT_TRUE(result.low_rank.allFinite());
  const Matrix line = [&] {
    Matrix filled = motion.block(100, 3, 30, 3);
    for (Index i = 0; i < 30; ++i)
      filled.row(i) = motion.row(99).segment(3, 3) +
                      static_cast<double>(i + 1) / 31 *
                          (motion.row(130).segment(3, 3) - motion.row(99).segment(3, 3));
    return filled;
  }();
  const Matrix hidden = motion.block(100, 3, 30, 3);
  EXPECT_LE(rms(result.low_rank.block(100, 3, 30, 3) - hidden), 0.2 * rms(line - hidden));
  EXPECT_GE(result.deviation.block(110, 3, 10, 3).minCoeff(), result.deviation(50, 3));
}

TEST(MatrixNormal, DrawsMissingSamplesToWhereTheyShouldBe) {
  const Matrix motion = walk(300, 12);
  Matrix data = motion;
  data.block(100, 3, 90, 3).setConstant(nan);
  Matrix variance = Matrix::Constant(300, 4, std::numeric_limits<double>::infinity());
  variance.col(1).segment(100, 90).setConstant(1e-6);
  const MotionPrior prior{.size = 10, .positions = motion, .variance = variance};

  const auto blind = reference::solve(data, MatrixNormal{});
  const auto drawn = reference::solve(data, MatrixNormal{}, {}, prior);

  const auto off = [&](const auto& result) {
    return rms((result.low_rank - motion).block(100, 3, 90, 3));
  };
  EXPECT_LE(off(drawn), 0.3 * off(blind));
  EXPECT_LE(drawn.deviation.block(100, 3, 90, 3).maxCoeff(), 1.02e-3);  // the floor beside it
  EXPECT_GT(blind.deviation(145, 3), 0.01);
  EXPECT_TRUE((drawn.trusted.block(100, 3, 90, 3).array() == 0).all());
}

TEST(MatrixNormal, ScalesWithItsData) {
  const Matrix data = spoilt(walk(150, 9), 4);
  const auto expected = reference::solve(data, MatrixNormal{});

  for (const double scale : {1e-3, 25.4, 1e3}) {
    const auto scaled = reference::solve(scale * data, MatrixNormal{});
    EXPECT_LE(test::relative_difference(scaled.low_rank / scale, expected.low_rank), 1e-9) << scale;
    EXPECT_LE(test::relative_difference(scaled.deviation / scale, expected.deviation), 1e-9)
        << scale;
  }
}

TEST(MatrixNormal, KeepsImpactsUnderNoise) {
  Matrix motion = test::model_motion(400, 21, 1).motion;
  const std::vector<Index> impacts = {60, 130, 190, 270, 340};
  const auto change = [&](const Matrix& m, Index k) -> Eigen::RowVectorXd {
    return m.row(k - 1) - 2 * m.row(k) + m.row(k + 1);
  };
  for (const Index k : impacts) {  // velocities change at once
    const Eigen::RowVectorXd jump = 10 * change(motion, k);
    for (Index i = k; i < 400; ++i) motion.row(i) += static_cast<double>(i - k) * jump;
  }
  const Matrix noisy = motion + 4 * test::random_matrix(400, 21, 2);

  const Matrix cleaned = reference::solve(noisy, MatrixNormal{}).low_rank;

  double kept = 0;
  for (const Index k : impacts)
    kept += change(cleaned, k).dot(change(motion, k)) / change(motion, k).squaredNorm() / 5;
  EXPECT_GE(kept, 0.5);  // 0.63; 0.19 if all accelerations had one scale
  EXPECT_LE(rms(cleaned - motion), 0.35 * rms(noisy - motion));
}

TEST(MatrixNormal, IsTheSamePlayedBackward) {
  const Matrix data = spoilt(walk(150, 9), 4);

  const Matrix forward = reference::solve(data, MatrixNormal{}).low_rank;
  const Matrix backward = reference::solve(data.colwise().reverse(), MatrixNormal{}).low_rank;

  EXPECT_LE(test::relative_difference(backward.colwise().reverse(), forward), 1e-9);
}

TEST(MatrixNormal, LeavesColumnsWithoutASampleMissing) {
  Matrix data = walk(100, 9);
  data.col(4).setConstant(nan);

  const auto result = reference::solve(data, MatrixNormal{});

  EXPECT_TRUE(result.low_rank.col(4).array().isNaN().all());
  EXPECT_EQ(result.low_rank.array().isNaN().count(), 100);
}

TEST(MatrixNormal, TakesShortAndNarrowAndWideAndConstantData) {
  for (const Index rows : {1, 2, 3, 4, 5, 20})
    for (const Index columns : {1, 2, 9, 30}) {
      const Matrix data = walk(rows, columns);
      const Matrix cleaned = reference::solve(data, MatrixNormal{}).low_rank;
      EXPECT_TRUE(cleaned.allFinite()) << rows << " x " << columns;
      EXPECT_LE(rms(cleaned - data), 0.1) << rows << " x " << columns;
    }
  const Matrix constant = Matrix::Constant(50, 9, 3);
  EXPECT_LE(rms(reference::solve(constant, MatrixNormal{}).low_rank - constant), 1e-12);
  const Matrix zero = Matrix::Zero(50, 9);
  EXPECT_EQ(reference::solve(zero, MatrixNormal{}).low_rank, zero);
  const Matrix unseen = Matrix::Constant(50, 9, nan);
  EXPECT_TRUE(reference::solve(unseen, MatrixNormal{}).low_rank.array().isNaN().all());
}

// The noise of half of the samples is five times that of the others.
TEST(MatrixNormal, WeighsSamplesByTheirConfidence) {
  const Matrix truth = test::synthetic_walk(300).samples.leftCols(24);
  Matrix confidence = Matrix::Ones(300, 24);
  for (Index i = 0; i < 300; ++i)
    for (Index j = 0; j < 24; ++j)
      if ((i * 7 + j / 3 * 5) % 11 < 5) confidence(i, j) = 1. / 25;
  const Matrix noise = 0.05 * test::random_matrix(300, 24, 3).cwiseQuotient(confidence.cwiseSqrt());
  const Matrix data = truth + noise;
  const auto off = [&](const MotionPrior& prior) {
    return (reference::solve(data, MatrixNormal{}, {}, prior).low_rank - truth).norm();
  };

  const double unweighed = off({});

  EXPECT_LT(off({.confidence = confidence}), 0.75 * unweighed);
  EXPECT_EQ(off({.confidence = Matrix::Ones(300, 24)}), unweighed);
  // Only their ratios matter: sigma takes what they have in common.
  EXPECT_NEAR(off({.confidence = 0.5 * confidence}) / off({.confidence = confidence}), 1, 0.05);
}

TEST(MatrixNormal, RefusesParametersOutOfRange) {
  EXPECT_THROW(check(MatrixNormal{.median_frames = 4}), ArgumentError);
  EXPECT_THROW(check(MatrixNormal{.soft_steps = 0}), ArgumentError);
  EXPECT_THROW(check(MatrixNormal{.hard = nan}), ArgumentError);
}

}  // namespace
}  // namespace moclean
