#include "moclean/body/taken_back.hpp"

#include <gmock/gmock.h>

#include "moclean/body/rigid_flags.hpp"
#include "moclean/core/random.hpp"

#include "support/hand.hpp"

namespace moclean {
namespace {

constexpr double noise = 0.01;  // a hundredth of a bone

void displace(Index joint, Index first, Matrix& samples) {
  samples.middleRows(first, 20).middleCols(3 * joint, 3).rowwise() +=
      Eigen::RowVector3d(0.7, -0.5, 0.6);
}

RigidFlags flags_in_noise(Matrix samples, bool white = true) {
  Random random(11);
  for (double& x : samples.reshaped()) x += noise * random.normal();
  const BodyTake take = body_take(samples, 120);
  const double smallest = noise_of_distance * noise;
  return vote_on_joints(take, learn_rigid_body(take, smallest), body_size(take), smallest, white);
}

TEST(TakeBackTurning, KeepsAThumbThatFlipsThoughNoiseHidesItsBone) {
  Matrix samples = test::limbs_with_hand(400);
  test::flip(test::thumb, 200, 240, samples);
  const RigidFlags flags = flags_in_noise(samples);

  EXPECT_FALSE(flags.bad.any());
  EXPECT_TRUE(flags.confirmed.col(11).segment(205, 30).all());
}

TEST(TakeBackTurning, KeepsNothingWhereNeighbouringFramesShareTheirNoise) {
  Matrix samples = test::limbs_with_hand(400);
  test::flip(test::thumb, 200, 240, samples);
  const RigidFlags flags = flags_in_noise(samples, false);

  EXPECT_GE(flags.bad.col(test::thumb).segment(200, 40).count(), 36);
}

TEST(TakeBackTurning, KeepsNoRunThatIsALengthAwayByChance) {
  // One of five errors keeps a length: with so many others it is taken for an error, too.
  Matrix samples = test::limbs_with_hand(400);
  test::flip(test::thumb, 200, 220, samples);
  for (const auto& [joint, first] : {std::pair{3, 40}, {5, 90}, {10, 140}, {6, 260}})
    displace(joint, first, samples);
  const RigidFlags flags = flags_in_noise(samples);

  EXPECT_GE(flags.bad.col(11).segment(200, 20).count(), 18);
  EXPECT_GE(flags.bad.col(5).segment(90, 20).count(), 18);
}

TEST(TakeBackTurning, KeepsNoErrorThatIsNearALength) {
  // On average the thumb is a tenth of its bone too far from the wrist: six deviations.
  Matrix samples = test::limbs_with_hand(400);
  test::flip(test::thumb, 200, 240, samples, 1.1);
  const RigidFlags flags = flags_in_noise(samples);

  EXPECT_GE(flags.bad.col(11).segment(200, 40).count(), 36);
}

}  // namespace
}  // namespace moclean
