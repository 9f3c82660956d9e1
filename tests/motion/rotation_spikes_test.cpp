#include "moclean/motion/rotation_spikes.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "support/matrix.hpp"

namespace moclean {
namespace {

using enum Channel;
using std::numbers::pi;

constexpr double degree = pi / 180;

// An arm that moves along x: three rotations, two, one about an axis, and a tip.
Skeleton arm_of_spikes() {
  Skeleton skeleton;
  skeleton.bones = {
      {.name = "shoulder", .channels = {translate_x, translate_y, rotate_z, rotate_x, rotate_y}},
      {.name = "elbow", .parent = 0, .offset = {3, 0, 0}, .channels = {rotate_z, rotate_y}},
      {.name = "hand", .parent = 1, .offset = {2, 0, 0}, .channels = {rotate_y}},
      {.name = "tip", .parent = 2, .offset = {1, 0, 0}}};
  return skeleton;
}

// 120 frames of smooth motion, up to 3 degrees a frame.
Matrix swing() {
  Matrix channels(120, 8);
  for (Index f = 0; f < channels.rows(); ++f)
    for (Index c = 0; c < channels.cols(); ++c) {
      const double phase = 0.04 * static_cast<double>(f) + static_cast<double>(c);
      channels(f, c) = (c < 2 ? 2 : 1.3) * std::sin(phase);
    }
  return channels;
}

struct Damage {
  Index frame, frames, channel;
  double size;
};

class Spike : public testing::TestWithParam<Damage> {};

TEST_P(Spike, IsTakenOutAndNothingElse) {
  const Damage& damage = GetParam();
  const Matrix clean = swing();
  Matrix channels = clean;
  channels.col(damage.channel).segment(damage.frame, damage.frames).array() += damage.size;

  const std::vector<RotationSpike> found = take_out_spikes(arm_of_spikes(), channels);

  ASSERT_EQ(found.size(), 1);
  EXPECT_EQ(found[0].first, damage.frame);
  EXPECT_EQ(found[0].frames, damage.frames);
  EXPECT_NEAR(found[0].size, std::abs(damage.size), 0.1 * std::abs(damage.size));
  EXPECT_EQ(found[0].is_turn, damage.channel >= 2);
  EXPECT_LE(test::largest_difference(channels, clean), 0.02 * std::abs(damage.size));
  const Index after = damage.frame + damage.frames;
  EXPECT_TRUE(
      test::same_bits(channels.topRows(damage.frame).eval(), clean.topRows(damage.frame).eval()));
  EXPECT_TRUE(test::same_bits(channels.bottomRows(120 - after).eval(),
                              clean.bottomRows(120 - after).eval()));
}

INSTANTIATE_TEST_SUITE_P(
    Each, Spike,
    testing::Values(Damage{40, 1, 2, 5 * degree}, Damage{40, 2, 3, 10 * degree},
                    Damage{2, 1, 4, -20 * degree}, Damage{116, 2, 4, 60 * degree},
                    Damage{60, 1, 5, 40 * degree}, Damage{61, 2, 6, 7 * degree},
                    Damage{62, 1, 7, -5 * degree}, Damage{50, 1, 0, 1.0}, Damage{50, 2, 1, -0.5}));

TEST(RotationSpikes, LeaveSmoothMotionToTheBit) {
  Matrix channels = swing();

  EXPECT_TRUE(take_out_spikes(arm_of_spikes(), channels).empty());
  EXPECT_TRUE(test::same_bits(channels, swing()));
}

TEST(RotationSpikes, LeaveStepsAndWholeTurns) {
  Matrix channels = swing();
  channels.col(2).tail(60).array() += 30 * degree;
  channels.col(3).segment(20, 1).array() += 2 * pi;
  const Matrix given = channels;

  EXPECT_TRUE(take_out_spikes(arm_of_spikes(), channels).empty());
  EXPECT_TRUE(test::same_bits(channels, given));
}

// The same rotation by other angles is no jump.
TEST(RotationSpikes, LeaveAnglesThatGoTheOtherWayRound) {
  Matrix channels = swing();
  channels.row(30).segment<3>(2) =
      Eigen::RowVector3d(channels(30, 2) + pi, pi - channels(30, 3), channels(30, 4) + pi);

  EXPECT_TRUE(take_out_spikes(arm_of_spikes(), channels).empty());
}

// The elbow takes back what the shoulder does: the forearm stays, so it is no damage of one
// channel.
TEST(RotationSpikes, LeaveATurnThatTheNextJointTakesBack) {
  Matrix channels = Matrix::Zero(40, 8);
  channels(20, 2) = 6 * degree;
  channels(20, 5) = -6 * degree;
  Skeleton skeleton = arm_of_spikes();
  skeleton.bones[1].offset = {0.1, 0, 0};
  skeleton.bones[2].offset = {5, 0, 0};

  EXPECT_TRUE(take_out_spikes(skeleton, channels).empty());
}

TEST(RotationSpikes, LeaveFramesBesideMissingChannels) {
  Matrix channels = swing();
  channels(40, 2) = std::numeric_limits<double>::quiet_NaN();
  channels(42, 2) += 20 * degree;
  channels(80, 2) += 20 * degree;

  const std::vector<RotationSpike> found = take_out_spikes(arm_of_spikes(), channels);

  ASSERT_EQ(found.size(), 1);
  EXPECT_EQ(found[0].first, 80);
  EXPECT_TRUE(std::isnan(channels(40, 2)));
}

TEST(RotationSpikes, TakeTakesOfAnyLength) {
  for (const Index frames : {0, 1, 2, 4, 5, 6}) {
    Matrix channels = swing().topRows(frames);
    EXPECT_TRUE(take_out_spikes(arm_of_spikes(), channels).empty());
  }
}

}  // namespace
}  // namespace moclean
