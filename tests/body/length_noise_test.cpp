#include "moclean/body/length_noise.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/random.hpp"

#include "support/correlated_noise.hpp"
#include "support/limbs.hpp"

namespace moclean {
namespace {

constexpr Index frames = 1200, joints = 16;

Matrix body() { return test::swinging_limbs(frames, joints); }

Matrix noise(double correlation) {
  return 0.05 * test::correlated_noise(frames, 3 * joints, correlation);
}

LengthNoise noise_of(const Matrix& samples) { return length_noise(body_take(samples, 120)); }

double size_of(const Matrix& samples) { return body_size(body_take(samples, 120)); }

TEST(LengthNoise, IsNoneWhereLengthsAreExact) {
  const LengthNoise found = noise_of(body());

  EXPECT_LE(found.deviation, 1e-12);
  EXPECT_FALSE(found.correlated(size_of(body()), 0));
}

TEST(LengthNoise, IsWhatWasAddedButNotCorrelatedIfWhite) {
  const LengthNoise found = noise_of(body() + noise(0));

  EXPECT_NEAR(found.deviation, 0.05, 0.005);
  EXPECT_NEAR(found.slow, 0.05, 0.01);
  EXPECT_TRUE(found.steady);
  EXPECT_FALSE(found.correlated(size_of(body()), 0));
}

TEST(LengthNoise, IsLargerAtLowFrequenciesIfFramesErrAlike) {
  const LengthNoise found = noise_of(body() + noise(0.8));

  EXPECT_NEAR(found.deviation, 0.05, 0.0075);
  EXPECT_NEAR(found.slow, 0.05 * 3, 0.04);  // sqrt(1.8 / 0.2)
  EXPECT_TRUE(found.correlated(size_of(body()), 0));
}

TEST(LengthNoise, StaysWhereSomeSamplesAreFarOff) {
  Matrix spoilt = body() + noise(0.8);
  for (Index first = 0; first + 20 <= frames; first += 100)
    spoilt.middleRows(first, 20).middleCols(3 * (first / 100), 3).array() += 3;

  const LengthNoise found = noise_of(spoilt), before = noise_of(body() + noise(0.8));

  EXPECT_NEAR(found.deviation, before.deviation, 0.1 * before.deviation);
  EXPECT_TRUE(found.correlated(size_of(body()), 0));
}

TEST(LengthNoise, ScalesWithTheData) {
  const LengthNoise found = noise_of(1000 * (body() + noise(0.8))),
                    before = noise_of(body() + noise(0.8));

  EXPECT_NEAR(found.deviation, 1000 * before.deviation, 1e-9 * found.deviation);
  EXPECT_NEAR(found.slow, 1000 * before.slow, 1e-9 * found.slow);
}

TEST(LengthNoise, IsNotMotionBetweenMarkersWithoutABone) {
  // Each swings by itself, at 0.5 to 1.5 Hz about a place of its own.
  Random random(4);
  Matrix samples(frames, 3 * joints);
  for (Index c = 0; c < samples.cols(); ++c) {
    const double speed = 2 * M_PI * (0.5 + random.uniform()) / 120, phase = 7 * random.uniform();
    const double place = 10 * random.uniform();
    for (Index i = 0; i < frames; ++i)
      samples(i, c) = place + 0.3 * std::sin(speed * static_cast<double>(i) + phase);
  }

  EXPECT_FALSE(noise_of(samples).correlated(size_of(samples), 0));
}

TEST(LengthNoise, IsNotWhatRestsWhileTheBodyRests) {
  Matrix play = noise(0.8);
  for (Index i = 0; i < frames; ++i) play.row(i) *= i % 240 < 120 ? 0.05 : 1;

  const LengthNoise found = noise_of(body() + play);

  EXPECT_FALSE(found.steady);
  EXPECT_FALSE(found.correlated(size_of(body()), 0));
}

TEST(LengthNoise, IsNotTheLatticeOfRoundedSamples) {
  const Matrix whole = body();
  Matrix slow = whole;  // 20 times slower
  for (Index i = 0; i < frames; ++i) {
    const double part = static_cast<double>(i % 20) / 20;
    slow.row(i) = (1 - part) * whole.row(i / 20) + part * whole.row(i / 20 + 1);
  }
  const Matrix rounded = (slow / 0.3).array().round() * 0.3;

  EXPECT_FALSE(noise_of(rounded).steady);
}

TEST(LengthNoise, IsNotHiddenIfDifferencesInTimeShowIt) {
  const LengthNoise found = noise_of(body() + noise(0.8));

  EXPECT_TRUE(found.correlated(size_of(body()), 0.4 * found.deviation));
  EXPECT_FALSE(found.correlated(size_of(body()), 0.6 * found.deviation));
}

TEST(WorthwhileShare, IsAllTheWayToTheTruthAndNoneToWhatTakesMotionOnly) {
  const Matrix truth = body(), noisy = truth + noise(0.8);
  Matrix drifted = noisy;
  drifted.col(0).array() += 1;  // no length of others changes
  const BodyTake take = body_take(noisy, 120);

  EXPECT_GE(worthwhile_share(take, truth), 0.9);
  EXPECT_NEAR(worthwhile_share(take, drifted), 0, 0.02);
  EXPECT_EQ(worthwhile_share(take, noisy), 1);
}

TEST(WorthwhileShare, IsLessWhereMotionGoesWithTheNoise) {
  const Matrix truth = body(), noisy = truth + noise(0.8);
  Matrix shifted = truth;
  shifted.rowwise() += Eigen::RowVectorXd::Constant(shifted.cols(), 0.05);

  const double share = worthwhile_share(body_take(noisy, 120), shifted);

  EXPECT_NEAR(share, 0.5, 0.1);  // as much of bias as of noise
}

TEST(LengthNoise, NeedsEightLengths) {
  const LengthNoise found = noise_of((body() + noise(0.8)).leftCols(3 * 6));

  EXPECT_EQ(found.deviation, 0);
}

}  // namespace
}  // namespace moclean
