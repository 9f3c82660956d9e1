#include "moclean/metric/motion_error.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;
using testing::ThrowsMessage;

// A joint `a` and a joint `b` that hangs on it.
Recording two_joints(const Matrix& samples) {
  return {.samples = samples, .columns = {"a.x", "a.y", "a.z", "b.x", "b.y", "b.z"}, .unit = ""};
}

Recording one_channel(const Matrix& samples) {
  return {.samples = samples, .columns = {"force"}, .unit = ""};
}

TEST(PositionError, IsTheMeanDistanceOfAJoint) {
  const Recording truth = two_joints(Matrix{{0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, 1}});
  const Recording estimate = two_joints(Matrix{{3, 4, 0, 1, 1, 1}, {0, 0, 0, 3, 2, 3}});

  EXPECT_NEAR(position_error(truth, estimate), (5 + 0 + 0 + 3) / 4.0, test::tolerance::by_hand(8));
}

TEST(PositionError, LeavesOutAJointThatIsPartlyUnseen) {
  const Recording truth = two_joints(Matrix{{0, 0, 0, 1, 1, 1}});
  const Recording estimate = two_joints(Matrix{{nan, 4, 0, 3, 2, 3}});

  EXPECT_NEAR(position_error(truth, estimate), 3, test::tolerance::by_hand(3));
  EXPECT_TRUE(std::isnan(position_error(truth, two_joints(Matrix::Constant(1, 6, nan)))));
}

TEST(WorstDisplacement, IsTheLargestDistanceInAllThreeCoordinates) {
  const Recording truth = two_joints(Matrix{{0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, 1}});
  const Recording estimate = two_joints(Matrix{{3, 4, 0, 1, 1, 5.5}, {nan, 40, 0, 3, 2, 3}});

  EXPECT_NEAR(worst_displacement(truth, estimate), 5, test::tolerance::by_hand(5));
  EXPECT_EQ(worst_displacement(truth, truth), 0);
  EXPECT_TRUE(std::isnan(worst_displacement(truth, two_joints(Matrix::Constant(2, 6, nan)))));
}

TEST(LiPositionError, IsTheNormOverTheNumberOfEntries) {
  const Recording truth = two_joints(Matrix{{0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, 1}});
  const Recording estimate = two_joints(Matrix{{3, 4, 0, 1, 1, 1}, {0, 0, 0, 13, 1, 1}});

  EXPECT_NEAR(li_position_error(truth, estimate), 13 / 12.0, test::tolerance::by_hand(2));
}

TEST(LiPositionError, LeavesNaNOutOfSumAndSize) {
  const Recording truth = two_joints(Matrix{{0, 0, 0, 1, nan, 1}});

  EXPECT_NEAR(li_position_error(truth, two_joints(Matrix{{3, 4, 0, 1, 1, 1}})), 5 / 5.0,
              test::tolerance::by_hand(2));
}

TEST(BoneLengthError, IsTheMeanDeviationFromTheLengthOfTheTruth) {
  const std::vector<int> parents = {-1, 0};
  const Recording truth =
      two_joints(Matrix{{0, 0, 0, 0, 0, 1}, {5, 5, 5, 8, 5, 5}});  // lengths 1, 3
  const Recording estimate = two_joints(Matrix{{1, 1, 1, 4, 5, 1}, {0, 0, 0, 0, 1, 0}});  // 5, 1

  EXPECT_NEAR(bone_length_error(truth, estimate, parents), (3 + 1) / 2.0,
              test::tolerance::by_hand(5));
}

TEST(BoneLengthError, IsZeroForAMovedCopyOfARigidBody) {
  const std::vector<int> parents = {-1, 0};
  const Recording truth = two_joints(Matrix{{0, 0, 0, 0, 0, 2}, {1, 0, 0, 3, 0, 0}});

  EXPECT_EQ(bone_length_error(truth, two_joints(truth.samples.array() + 4), parents), 0);
}

TEST(BoneLengthError, LeavesOutFramesWithAnUnseenEnd) {
  const std::vector<int> parents = {-1, 0};
  const Recording truth = two_joints(Matrix{{0, 0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, nan}});
  const Recording estimate = two_joints(Matrix{{nan, 0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 4}});

  EXPECT_NEAR(bone_length_error(truth, estimate, parents), 3, test::tolerance::by_hand(4));
}

TEST(BoneLengthError, RefusesParentsOfAnotherSkeleton) {
  const Recording clip = two_joints(Matrix::Zero(1, 6));

  EXPECT_THAT([&] { bone_length_error(clip, clip, std::vector<int>{-1}); },
              ThrowsMessage<ShapeError>("1 parents do not fit 2 joints"));
}

TEST(SmoothnessError, FollowsTheEquationOnPaper) {
  // Y' = 1 1 4 2 2 with O: 0, 3, -5, 2, 0; the norm is sqrt(9 + 25 + 4), f + 2 = 5, d = 1.
  EXPECT_NEAR(smoothness_error(one_channel(Matrix{{1}, {4}, {2}})), std::sqrt(38.0) / 5,
              test::tolerance::by_hand(4));
}

TEST(SmoothnessError, IsZeroAtRestAndLeavesNaNOut) {
  EXPECT_EQ(smoothness_error(one_channel(Matrix::Constant(9, 1, 3.5))), 0);
  // Differences of frames 0 (3 - 1 = 2) and 4 (0 - 7 = -7) are left; 2 of them and 2 zeros.
  EXPECT_NEAR(smoothness_error(one_channel(Matrix{{1}, {3}, {nan}, {0}, {7}})),
              std::sqrt(0 + 4 + 49.0) / 4, test::tolerance::by_hand(7));
  EXPECT_TRUE(std::isnan(smoothness_error(one_channel(Matrix{{nan}, {nan}}))));
}

TEST(AccelerationError, IsTheMeanNormOfTheSecondDifferenceOfTheError) {
  const Recording truth = two_joints(Matrix::Zero(4, 6));
  Recording estimate = two_joints(Matrix::Zero(4, 6));
  estimate.samples(1, 0) = 3;  // second differences of a.x at frames 1 and 2: -6, 3
  estimate.samples(1, 1) = 4;  // of a.y: -8, 4

  EXPECT_NEAR(acceleration_error(truth, estimate), (10 + 5 + 0 + 0) / 4.0,
              test::tolerance::by_hand(10));
}

TEST(AccelerationError, DoesNotSeeAConstantVelocity) {
  const Recording truth = one_channel(Matrix{{4}, {1}, {-5}, {2}});
  const Recording estimate = one_channel(Matrix{{4 + 1}, {1 + 3}, {-5 + 5}, {2 + 7}});

  EXPECT_EQ(acceleration_error(truth, estimate), 0);
  EXPECT_TRUE(std::isnan(
      acceleration_error(one_channel(Matrix::Zero(2, 1)), one_channel(Matrix::Zero(2, 1)))));
}

TEST(MotionErrors, RefuseDifferentShapes) {
  const Recording a = two_joints(Matrix::Zero(3, 6)), b = two_joints(Matrix::Zero(4, 6));

  EXPECT_THROW(position_error(a, b), ShapeError);
  EXPECT_THROW(worst_displacement(a, b), ShapeError);
  EXPECT_THROW(li_position_error(a, b), ShapeError);
  EXPECT_THROW(bone_length_error(a, b, std::vector<int>{-1, 0}), ShapeError);
  EXPECT_THROW(acceleration_error(a, b), ShapeError);
}

}  // namespace
}  // namespace moclean
