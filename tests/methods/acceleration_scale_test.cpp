// Scales of accelerations in time: by hand, and of motion that has them.
#include "moclean/methods/matrix_normal/acceleration_scale.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "moclean/methods/matrix_normal/window.hpp"

#include "support/matrix.hpp"

namespace moclean {
namespace {

Mask all_used(Index frames, Index columns) { return Mask::Constant(frames, columns, true); }

TEST(AccelerationPrecision, IsThatOfTheEvidence) {
  Matrix motion(4, 1);
  motion << 1, 0, 2, 5;  // accelerations 3, 1
  const Matrix R = Matrix::Constant(1, 1, 0.25);
  const Eigen::VectorXd spectrum = Eigen::VectorXd::Constant(1, 4);
  const Eigen::Vector2d before(1, 0.5);
  Mask used = all_used(4, 1);

  const Eigen::VectorXd clean = acceleration_precision(motion, R, spectrum, 0, used, before);
  EXPECT_DOUBLE_EQ(clean(0), (3. + 1) / (3 + 9. / 4));
  EXPECT_DOUBLE_EQ(clean(1), (3. + 1) / (3 + 1. / 4));

  const Eigen::VectorXd noisy = acceleration_precision(motion, R, spectrum, 7, used, before);
  EXPECT_DOUBLE_EQ(noisy(0), (3 + kept_power(7, 4)) / (3 + 9. / 4));
  EXPECT_DOUBLE_EQ(noisy(1), (3 + kept_power(7, 8)) / (3 + 1. / 4));

  used(0, 0) = false;  // of the first alone
  const Eigen::VectorXd lost = acceleration_precision(motion, R, spectrum, 0, used, before);
  EXPECT_DOUBLE_EQ(lost(0), 23 / (23 + 9. / 4));
  EXPECT_DOUBLE_EQ(lost(1), clean(1));
}

TEST(AccelerationPrecision, FindsTheScaleOfEveryFrame) {
  constexpr Index count = 300, columns = 60;
  Matrix a = test::random_matrix(count, columns, 1);
  const auto scale = [](Index k) { return k % 50 == 0 ? 10. : k < 150 ? 0.5 : 1.; };
  for (Index k = 0; k < count; ++k) a.row(k) *= scale(k);
  Matrix motion = Matrix::Zero(count + 2, columns);
  for (Index k = 0; k < count; ++k)
    motion.row(k + 2) = 2 * motion.row(k + 1) - motion.row(k) + a.row(k);

  const Eigen::VectorXd precision = acceleration_precision(
      motion, Matrix::Identity(columns, columns), Eigen::VectorXd::Ones(columns), 0,
      all_used(count + 2, columns), Eigen::VectorXd::Ones(count));

  for (Index k = 0; k < count; ++k)
    EXPECT_NEAR(std::log(precision(k) * scale(k) * scale(k)), 0, 0.9) << k;  // 0.18, deviation
}

TEST(AccelerationWeights, GoHalfWayAndHaveTheMeanSquareOne) {
  const Eigen::VectorXd weights = acceleration_weights(Eigen::Vector2d(1, 16));

  EXPECT_DOUBLE_EQ(weights(0), 1 / std::sqrt(2.5));
  EXPECT_DOUBLE_EQ(weights(1), 2 / std::sqrt(2.5));
  EXPECT_EQ(acceleration_weights(Eigen::VectorXd::Constant(7, 0.3)).maxCoeff(), 1);
}

}  // namespace
}  // namespace moclean
