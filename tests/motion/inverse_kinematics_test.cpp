#include "moclean/motion/inverse_kinematics.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"

#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using enum Channel;
using test::largest_difference;
using test::same_bits;

using std::numbers::pi;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// What the issue asks of joints, of the body's size; a search that has converged is far below.
constexpr double found = 1e-9;

// An arm in the plane: shoulder at the origin, elbow 2 away, hand 1 further.
Skeleton arm() {
  Skeleton skeleton;
  skeleton.bones = {{.name = "shoulder", .channels = {rotate_z, rotate_y, rotate_x}},
                    {.name = "elbow",
                     .parent = 0,
                     .offset = {2, 0, 0},
                     .channels = {rotate_z, rotate_y, rotate_x}},
                    {.name = "hand",
                     .parent = 1,
                     .offset = {1, 0, 0},
                     .channels = {rotate_z, rotate_y, rotate_x}}};
  return skeleton;
}

TEST(InverseKinematics, BendsAnArmAsOnPaper) {
  const Matrix rest = Matrix::Zero(1, 9);
  const Matrix positions{{0, 0, 0, 0, 2, 0, -1, 2, 0}};

  const Matrix channels = inverse_kinematics(arm(), rest, positions);

  const Matrix expected{{pi / 2, 0, 0, pi / 2, 0, 0, 0, 0, 0}};
  EXPECT_LE(largest_difference(channels, expected), found);
}

TEST(InverseKinematics, KeepsTheTwistThatPositionsDoNotShow) {
  const Matrix twisted{{0, 0, 0.7, 0, 0, -0.2, 0.1, 0.2, 0.3}};
  const Matrix positions{{0, 0, 0, 0, 2, 0, 0, 3, 0}};

  const Matrix channels = inverse_kinematics(arm(), twisted, positions);

  // Rz(90) after the twist about x: the arc in the plane leaves it alone.
  const Matrix expected{{pi / 2, 0, 0.7, 0, 0, -0.2, 0.1, 0.2, 0.3}};
  EXPECT_LE(largest_difference(channels, expected), found);
}

TEST(InverseKinematics, BendsAnElbowThatIsMissing) {
  const Matrix rest{{0.3, 0, 0, -0.5, 0, 0, 0, 0, 0}};
  const Matrix positions{{0, 0, 0, nan, nan, nan, 0, 2.5, 0}};

  const Matrix joints = forward_kinematics(arm(), inverse_kinematics(arm(), rest, positions));

  EXPECT_LE(largest_difference(joints.rightCols(3), Matrix{{0, 2.5, 0}}), found);
}

TEST(InverseKinematics, TurnsAHingeAboutItsAxisAlone) {
  Skeleton leg;
  leg.bones = {{.name = "hip", .channels = {rotate_x, rotate_y, rotate_z}},
               {.name = "knee", .parent = 0, .offset = {0, -1, 0}, .channels = {rotate_x}},
               {.name = "foot", .parent = 1, .offset = {0, -1, 0}}};
  const Matrix bent{{0.2, 0.3, -0.1, 0.8}};

  const Matrix channels =
      inverse_kinematics(leg, Matrix{{0.1, 0.1, 0, 0.3}}, forward_kinematics(leg, bent));

  EXPECT_LE(largest_difference(channels, bent), 1e-7);
}

TEST(InverseKinematics, KeepsWhatWasNotCorrectedToTheBit) {
  Skeleton two = arm();
  for (Bone bone : arm().bones) {
    bone.parent += bone.parent < 0 ? 1 : 3;
    if (bone.name == "shoulder") bone.offset = {0, 0, 1};
    two.bones.push_back(bone);
  }
  two.bones[0].channels.insert(two.bones[0].channels.begin(),
                               {translate_x, translate_y, translate_z});
  const Matrix channels = Matrix::Random(3, two.channels());
  Matrix positions = forward_kinematics(two, channels);
  positions(1, 6) += 0.1;  // the first hand
  positions.row(2).setConstant(nan);

  const Matrix changed = inverse_kinematics(two, channels, positions);

  EXPECT_TRUE(same_bits(changed.row(0).eval(), channels.row(0).eval()));
  EXPECT_TRUE(same_bits(changed.row(2).eval(), channels.row(2).eval()));
  EXPECT_TRUE(same_bits(Matrix(changed.row(1).leftCols(6)), Matrix(channels.row(1).leftCols(6))));
  EXPECT_TRUE(
      same_bits(Matrix(changed.row(1).rightCols(12)), Matrix(channels.row(1).rightCols(12))));
  EXPECT_NE(changed(1, 6), channels(1, 6));
}

TEST(InverseKinematics, UnwrapsAnglesNextToTheInput) {
  const Matrix turned{{8 * pi + 0.1, 0, 0, -6 * pi, 0, 0, 0, 0, 0}};
  const Matrix wanted{{8 * pi - 0.2, 0.1, 0, -6 * pi + 0.3, 0, 0, 0, 0, 0}};

  const Matrix channels = inverse_kinematics(arm(), turned, forward_kinematics(arm(), wanted));

  EXPECT_LE(largest_difference(channels, turned), 0.5);
}

TEST(InverseKinematics, DoesNotFollowASpikeOfWholeTurns) {
  Matrix noisy = Matrix::Zero(5, 9);
  noisy(2, 0) = 4;
  const Matrix positions = forward_kinematics(arm(), Matrix::Constant(5, 9, 0.01));

  const Matrix channels = inverse_kinematics(arm(), noisy, positions);

  EXPECT_LE((channels.rightCols(9).col(0).array() - 0.01).abs().maxCoeff(), 0.1);
}

// Whatever number of turns a search makes about an axis of its own; a whole turn more where the
// input has it.
TEST(InverseKinematics, UnwrapsTheAngleOfAHinge) {
  Skeleton leg;
  leg.bones = {{.name = "hip", .channels = {rotate_x}},
               {.name = "foot", .parent = 0, .offset = {0, -1, 0}}};
  const Matrix start{{2 * pi + 0.1}, {2 * pi + 0.1}, {2.9}, {2 * pi}, {0.1}};
  const Matrix wanted{{0.3}, {0.5}, {0.6}, {0.6}, {0.7}};

  const Matrix channels = inverse_kinematics(leg, start, forward_kinematics(leg, wanted));

  const Matrix turns{{2 * pi}, {2 * pi}, {2 * pi}, {2 * pi}, {0}};
  EXPECT_LE(largest_difference(channels, wanted + turns), 1e-7);
}

// Two turns reach a direction in two ways; damage threw the input to the other one for two frames.
TEST(InverseKinematics, BendsABoneAsInTheFrameBefore) {
  Skeleton hand;
  hand.bones = {{.name = "hand", .channels = {rotate_z, rotate_x}, .tail = {0, -1, 0}}};
  Matrix wanted(6, 2), start;
  for (Index f = 0; f < 6; ++f) wanted.row(f) << 0.3 + 0.02 * static_cast<double>(f), 0.4;
  start = wanted;
  start.row(2) << wanted(2, 0) + pi + 0.3, pi - wanted(2, 1) + 0.2;
  start.row(3) << wanted(3, 0) + pi - 0.2, pi - wanted(3, 1) + 0.3;

  const Matrix channels = inverse_kinematics(hand, start, forward_kinematics(hand, wanted));

  EXPECT_LE(largest_difference(channels, wanted), 1e-7);
}

TEST(InverseKinematics, BeginsBetweenNeighboursWhereAChannelIsMissing) {
  Matrix given(3, 9);
  given << Matrix::Constant(1, 9, 0.1), Matrix::Constant(1, 9, nan), Matrix::Constant(1, 9, 0.3);
  const Matrix whole = forward_kinematics(arm(), Matrix::Constant(3, 9, 0.2));
  Matrix positions = whole;

  const Matrix filled = inverse_kinematics(arm(), given, positions);
  positions.row(1).tail(6).setConstant(nan);
  const Matrix hidden = inverse_kinematics(arm(), given, positions);

  // No position tells of the hand's turns, and of none where all below the shoulder is hidden.
  EXPECT_LE(largest_difference(forward_kinematics(arm(), filled).leftCols(9), whole), found);
  EXPECT_TRUE(filled.row(1).head(6).allFinite());
  EXPECT_NEAR(filled(1, 2), 0.2, 1e-6);
  EXPECT_TRUE(filled.row(1).tail(3).array().isNaN().all());
  EXPECT_TRUE(hidden.row(1).array().isNaN().all());
}

// A body of any shape: bones with three rotations, some with one or two, offsets or translations
// channels, a tail as bones of ASF have.
Skeleton random_skeleton(Random& random, bool has_hinges, bool has_tails) {
  const std::vector<std::vector<Channel>> sets = {
      {rotate_z, rotate_x, rotate_y}, {rotate_y, rotate_x, rotate_z},
      {rotate_x, rotate_y, rotate_z}, {rotate_x},
      {rotate_z, rotate_y},           {}};
  const auto vector = [&] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  };
  Skeleton skeleton;
  const auto bones = static_cast<int>(3 + random.below(18));
  for (int b = 0; b < bones; ++b) {
    Bone bone{.name = "b" + std::to_string(b)};
    bone.parent = b == 0 ? -1 : static_cast<int>(random.below(static_cast<std::uint64_t>(b)));
    bone.offset = vector();
    bone.channels = sets[b == 0 ? 0 : random.below(has_hinges ? sets.size() : 3)];
    if (b == 0)
      bone.channels.insert(bone.channels.begin(), {translate_x, translate_y, translate_z});
    if (has_tails && b > 0) bone.tail = vector();
    skeleton.bones.push_back(std::move(bone));
  }
  return skeleton;
}

// Where joints turn freely, any start will do; hinges, and bones whose joint is their far end, may
// be caught between two ways to bend, so they start near.
TEST(InverseKinematics, FindsPositionsThatTheSkeletonCanTake) {
  Random random(11);
  for (int i = 0; i < 90; ++i) {
    const bool has_hinges = i % 3 == 1, has_tails = i % 3 == 2;
    const Skeleton skeleton = random_skeleton(random, has_hinges, has_tails);
    Matrix wanted(8, skeleton.channels());
    for (double& value : wanted.reshaped()) value = random.normal();
    Matrix start = wanted;
    for (double& value : start.reshaped())
      value += (has_hinges || has_tails ? 0.02 : 1) * random.normal();
    const Matrix positions = forward_kinematics(skeleton, wanted);

    const Matrix channels = inverse_kinematics(skeleton, start, positions, 2);

    const Matrix error = forward_kinematics(skeleton, channels) - positions;
    // Where a joint is a bone's far end, steps get slower towards the end; a tenth of what a body's
    // joints may be off (1e-4 of its size, here some units) is left at most.
    EXPECT_LE(error.cwiseAbs().maxCoeff(), has_tails ? 2e-5 : 1e-6)
        << i << ": " << error.cwiseAbs().rowwise().maxCoeff().transpose();
  }
}

TEST(InverseKinematics, ComesAsNearAsNoSmallTurnCouldBetter) {
  Random random(12);
  const Skeleton skeleton = random_skeleton(random, true, false);
  Matrix wanted(4, skeleton.channels());
  for (double& value : wanted.reshaped()) value = random.normal();
  Matrix positions = forward_kinematics(skeleton, wanted);
  for (double& value : positions.reshaped()) value += 0.05 * random.normal();

  const Matrix channels = inverse_kinematics(skeleton, wanted, positions);

  const auto distance = [&](const Matrix& some) {
    return (forward_kinematics(skeleton, some) - positions).squaredNorm();
  };
  const double best = distance(channels);
  for (Index c = 0; c < channels.cols(); ++c)
    for (const double turn : {-1e-3, 1e-3}) {
      Matrix other = channels;
      other.col(c).array() += turn;
      EXPECT_GE(distance(other), best) << c;
    }
}

TEST(InverseKinematics, RefusesPositionsOfAnotherShape) {
  EXPECT_THROW(inverse_kinematics(arm(), Matrix::Zero(2, 9), Matrix::Zero(2, 6)), ShapeError);
  EXPECT_THROW(inverse_kinematics(arm(), Matrix::Zero(2, 9), Matrix::Zero(1, 9)), ShapeError);
}

}  // namespace
}  // namespace moclean
