// What is expected of accelerations before a take is looked at, and the step data was rounded to.
#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "moclean/core/random.hpp"
#include "moclean/methods/matrix_normal/prior.hpp"
#include "moclean/methods/matrix_normal/reference.hpp"
#include "moclean/methods/matrix_normal/rounding_step.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean {
namespace {

using test::nan;

Matrix rounded(const Matrix& data, double step) {
  return (data.array() / step).round().matrix() * step;
}

double rms(const Matrix& difference) {
  return difference.norm() / std::sqrt(static_cast<double>(difference.size()));
}

TEST(Nearness, FallsWithDistanceOverItsMedian) {
  Matrix positions(1, 9);
  positions << 0, 0, 0, 3, 0, 0, 3, 4, 0;  // distances 3, 5, 4

  const Matrix nearness = nearness_of(positions);

  Matrix expected(3, 3);
  const double a = std::exp(-3. / 4), b = std::exp(-5. / 4), c = std::exp(-1.);
  expected << 1, a, b, a, 1, c, b, c, 1;
  EXPECT_LE((nearness - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Nearness, LooksAtTheMiddleFramesOf32Parts) {
  Matrix positions = Matrix::Zero(64, 6);  // two joints, a thousand apart where nobody looks
  for (Index i = 0; i < 64; ++i)           // of each two frames the one towards the middle
    positions(i, 3) = (i < 32) == (i % 2 == 1) ? 1 : 1000;

  EXPECT_NEAR(nearness_of(positions)(0, 1), std::exp(-1.), 1e-15);
  EXPECT_NEAR(nearness_of(positions.colwise().reverse())(0, 1), std::exp(-1.), 1e-15);
}

TEST(Nearness, IsSemidefiniteAndOfNoUnit) {
  const Matrix positions = test::random_matrix(50, 30, 1);

  const Matrix nearness = nearness_of(positions);

  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(nearness);
  EXPECT_GE(eigen.eigenvalues().minCoeff(), 0);
  EXPECT_LE((nearness_of(1000 * positions) - nearness).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(nearness_of(Matrix::Zero(4, 6)), Matrix::Ones(2, 2));  // all at one place
}

TEST(Nearness, DrawsACovarianceAlongEachAxis) {
  Matrix nearness(2, 2);
  nearness << 1, 0.5, 0.5, 1;
  Matrix q = Matrix::Constant(6, 6, nan);  // the lower triangle is not read
  for (Index i = 0; i < 6; ++i)
    for (Index j = i; j < 6; ++j) q(i, j) = i == j ? (i < 3 ? 4 : 9) : 1;

  draw_to_nearness(nearness, 0.25, q);

  EXPECT_DOUBLE_EQ(q(0, 0), 4);
  EXPECT_DOUBLE_EQ(q(5, 5), 9);
  EXPECT_DOUBLE_EQ(q(0, 3), 0.75 * 1 + 0.25 * 0.5 * 2 * 3);
  EXPECT_DOUBLE_EQ(q(0, 4), 0.75 * 1);  // another axis
  EXPECT_EQ(q, q.transpose());
}

TEST(RoundingStep, IsFoundBesideOffsetsNoiseAndGaps) {
  Random random(3);
  const Matrix motion = test::synthetic_walk(300).samples.leftCols(12);
  Matrix data = rounded(motion, 0.37).rowwise() + test::random_matrix(1, 12, 5).row(0);
  data.block(40, 3, 30, 3).setConstant(nan);
  for (Index i = 0; i < data.rows(); i += 9) data(i, i % 12) += random.normal();

  EXPECT_NEAR(rounding_step(data), 0.37, 1e-9);
  EXPECT_NEAR(rounding_step(25.4 * data), 25.4 * 0.37, 1e-7);
  EXPECT_NEAR(rounding_step(data.cast<float>().cast<double>()), 0.37, 1e-5);
  EXPECT_NEAR(rounding_step(rounded(data, 1e-4)), 0.37, 1e-3);
  EXPECT_NEAR(rounding_deviation(data), 0.37 / std::sqrt(12.), 1e-9);
}

// Slower than a step in three frames: all second differences are one step, up or down.
TEST(RoundingStep, IsFoundInSlowMotion) {
  Matrix data(400, 3);
  for (Index i = 0; i < 400; ++i)
    for (Index j = 0; j < 3; ++j)
      data(i, j) = 2.5 * std::floor(static_cast<double>(i) / static_cast<double>(7 + 4 * j));

  EXPECT_NEAR(rounding_step(data), 2.5, 1e-9);
}

TEST(RoundingStep, IsNotFoundInSmoothOrNoisyOrUniformMotion) {
  const Matrix motion = test::synthetic_walk(300).samples.leftCols(12);

  EXPECT_EQ(rounding_step(motion), 0);
  EXPECT_EQ(rounding_step(motion + 0.1 * test::random_matrix(300, 12, 1)), 0);
  EXPECT_EQ(rounding_step(Matrix::Constant(100, 6, 3)), 0);
  Matrix ramp(100, 6);
  for (Index i = 0; i < 100; ++i) ramp.row(i).setConstant(0.5 * static_cast<double>(i * i));
  EXPECT_EQ(rounding_step(ramp), 0);
  EXPECT_EQ(rounding_step(motion.topRows(2)), 0);
}

// Fourth differences of a slow motion that was rounded are 0 in most places.
TEST(MatrixNormal, TakesRoundingForNoise) {
  const Matrix motion = test::synthetic_walk(400).samples.leftCols(12);
  for (const double step : {0.01, 0.1, 1.}) {
    const Matrix data = rounded(motion, step);

    const auto result = reference::solve(data, MatrixNormal{});

    EXPECT_LE(rms(result.low_rank - motion), rms(data - motion)) << step;
    EXPECT_GE(result.trusted.mean(), 0.999) << step;
  }
}

// Joints along a line, each shaken less than the whole line is: accelerations are alike where
// joints are near. A short window under dense noise tells little of a 90 x 90 covariance.
TEST(MatrixNormal, LeansOnNearnessWhereNoiseIsDense) {
  constexpr Index frames = 120, joints = 30;
  Random random(7);
  Matrix motion = Matrix::Zero(frames, 3 * joints), speed = Matrix::Zero(1, 3 * joints);
  for (Index j = 0; j < joints; ++j) motion(0, 3 * j) = static_cast<double>(j);
  for (Index i = 1; i < frames; ++i) {
    for (Index axis = 0; axis < 3; ++axis) {
      double shaken = 0.02 * random.normal();
      for (Index j = 0; j < joints; ++j)
        speed(0, 3 * j + axis) += shaken += 0.005 * random.normal();
    }
    motion.row(i) = motion.row(i - 1) + speed;
  }
  Matrix data = motion;
  for (Index i = 0; i < data.size(); ++i) data.data()[i] += random.normal();
  MatrixNormal columns;
  columns.joint_columns = 1;  // no joints, no prior

  const double with = rms(reference::solve(data, MatrixNormal{}).low_rank - motion);
  const double without = rms(reference::solve(data, columns).low_rank - motion);

  EXPECT_LE(with, 0.9 * without);
}

}  // namespace
}  // namespace moclean
