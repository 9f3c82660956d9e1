#include <cmath>

#include <gmock/gmock.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/core/random.hpp"
#include "moclean/denoise/automatic.hpp"

#include "support/hand.hpp"

namespace moclean {
namespace {

constexpr Index frames = 400, joints = test::hand_joints;
constexpr double noise = 0.01;  // a hundredth of a bone

Recording limbs() {
  return {.samples = test::limbs_with_hand(frames),
          .columns = default_column_names(3 * joints),
          .frame_rate = 120,
          .unit = ""};
}

Recording noisy(Recording clip) {
  Random random(5);
  for (double& x : clip.samples.reshaped()) x += noise * random.normal();
  return clip;
}

// The joints of the hand are at the other side of the wrist for a moment, one a little later: bones
// hold, but not the distances within the hand.
Recording with_flips(Recording clip) {
  for (const Index first : {120, 260}) {
    test::flip(9, first, first + 12, clip.samples);
    test::flip(10, first + 1, first + 13, clip.samples);
    test::flip(test::thumb, first + 2, first + 30, clip.samples);
  }
  return clip;
}

Recording with_bursts(Recording clip) {
  Random random(3);
  for (Index first = 20; first + 12 < frames; first += 24) {
    const auto joint = static_cast<Index>(random.uniform() * joints);
    for (Index c = 0; c < 3; ++c)
      clip.samples.col(3 * joint + c).segment(first, 12).array() +=
          (random.uniform() < 0.5 ? -1 : 1) * (0.5 + random.uniform());
  }
  return clip;
}

double rms(const Matrix& motion, const Recording& truth) {
  return (motion - truth.samples).norm() / std::sqrt(static_cast<double>(motion.size()));
}

Denoised cleaned(const Recording& clip, Rejection reject) {
  ReferenceBackend backend(2);
  return AutomaticDenoiser({.reject = reject}, backend).denoise(std::vector{clip})[0];
}

TEST(AutomaticRejections, AreTakenBackWhereDistancesBlameNobody) {
  const Recording truth = with_flips(limbs()), take = noisy(truth);
  const Denoised on = cleaned(take, Rejection::on), compared = cleaned(take, Rejection::automatic);

  EXPECT_FALSE(on.trusted->all());
  EXPECT_GT(compared.trusted->count(), on.trusted->count());
  EXPECT_LT(rms(compared.motion, truth), 0.9 * rms(on.motion, truth));
}

TEST(AutomaticRejections, StayWhereDistancesBlameThem) {
  const Recording take = noisy(with_bursts(limbs()));
  const Denoised on = cleaned(take, Rejection::on), compared = cleaned(take, Rejection::automatic);

  EXPECT_FALSE(on.trusted->all());
  EXPECT_EQ(compared.motion, on.motion);
}

}  // namespace
}  // namespace moclean
