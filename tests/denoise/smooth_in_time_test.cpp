#include "moclean/denoise/smooth_in_time.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "moclean/core/random.hpp"

#include "support/limbs.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean {
namespace {

Recording clip_of(Matrix samples) {
  const Index columns = samples.cols();
  return {.samples = std::move(samples),
          .columns = default_column_names(columns),
          .frame_rate = 120,
          .unit = ""};
}

bool smooth(const Matrix& samples) { return smooth_in_time(moving_part(clip_of(samples), true)); }

Matrix white(Index rows, Index columns, double sd, std::uint64_t seed = 1) {
  Random random(seed);
  Matrix samples(rows, columns);
  for (double& x : samples.reshaped()) x = sd * random.normal();
  return samples;
}

// Rank 8 and sparse errors: nothing about it is in time.
Matrix no_motion(Index rows, Index columns, std::uint64_t seed) {
  Matrix samples = white(rows, 8, 1, seed) * white(8, columns, 1, seed + 100);
  Random random(seed + 200);
  for (double& x : samples.reshaped())
    if (random.uniform() < 0.1) x += 20 * random.normal();
  return samples;
}

// White noise so many dB below the motion about its mean.
Matrix with_noise(const Matrix& motion, double decibel) {
  const Matrix centred = motion.rowwise() - motion.colwise().mean();
  const double power = centred.squaredNorm() / static_cast<double>(centred.size());
  return motion +
         white(motion.rows(), motion.cols(), std::sqrt(power / std::pow(10, decibel / 10)));
}

TEST(SmoothInTime, SaysNoToAMatrixThatIsNoMotion) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_FALSE(smooth(no_motion(100, 60, seed))) << seed;
    EXPECT_FALSE(smooth(no_motion(200, 93, seed))) << seed;
    EXPECT_FALSE(smooth(no_motion(400, 20, seed))) << seed;
    EXPECT_FALSE(smooth(no_motion(200, 93, seed).array() + 5)) << seed;
    EXPECT_FALSE(smooth(white(300, 30, 1e-200, seed))) << seed;
    EXPECT_FALSE(smooth(white(300, 30, 1e120, seed))) << seed;
  }
}

TEST(SmoothInTime, SaysNoToColumnsThatGoBackAndForthWithEveryFrame) {
  Matrix samples(48, 6);
  for (Index i = 0; i < 48; ++i) samples.row(i).setConstant(i % 2 == 0 ? 100 : -100);
  EXPECT_FALSE(smooth(samples));
}

TEST(SmoothInTime, SaysYesToMotionUnderHeavyNoise) {
  const Matrix walk = test::synthetic_walk(400).samples, limbs = test::swinging_limbs(200, 8);
  for (const Matrix& motion : {walk, limbs}) {
    EXPECT_TRUE(smooth(motion));
    EXPECT_TRUE(smooth(with_noise(motion, 1)));
    EXPECT_TRUE(smooth(with_noise(motion, -3)));
    EXPECT_TRUE(smooth(motion.array().round()));
  }
}

TEST(SmoothInTime, SaysYesWhereMostIsMissing) {
  Matrix samples = with_noise(test::synthetic_walk(300).samples, 1), zeros = samples;
  Random random(7);
  for (Index i = 0; i < samples.rows(); ++i)
    for (Index j = 0; j < samples.cols(); j += 3) {
      if (random.uniform() >= 0.6) continue;
      samples.row(i).segment(j, 3).setConstant(test::nan);
      if (random.uniform() < 0.5) zeros.row(i).segment(j, 3).setZero();
    }

  EXPECT_TRUE(smooth(samples));
  EXPECT_TRUE(smooth(zeros));
}

TEST(SmoothInTime, SaysYesToABodyAtRestHoweverItIsMeasured) {
  const Matrix pose = test::synthetic_walk(1).samples.replicate(300, 1);

  EXPECT_TRUE(smooth(pose));
  EXPECT_TRUE(smooth(pose + white(300, 93, 0.5)));
}

TEST(SmoothInTime, SaysYesToRandomWalksAndAnglesThatWrap) {
  Matrix walk = white(300, 12, 1);
  for (Index i = 1; i < 300; ++i) walk.row(i) += walk.row(i - 1);
  EXPECT_TRUE(smooth(walk));

  const Matrix angles = walk.array() * 20 - 360 * (walk.array() * 20 / 360).round();
  EXPECT_TRUE(smooth(angles));
}

TEST(SmoothInTime, SaysYesWhereThereIsTooLittleToTell) {
  EXPECT_TRUE(smooth(white(19, 93, 1)));
  EXPECT_TRUE(smooth(white(300, 3, 1)));
}

}  // namespace
}  // namespace moclean
