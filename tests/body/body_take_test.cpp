#include "moclean/body/body_take.hpp"

#include <gtest/gtest.h>

#include "moclean/body/vanished.hpp"
#include "moclean/core/error.hpp"

#include "support/limbs.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::nan;

TEST(BodyTake, SeesAJointWhoseThreeCoordinatesAreThere) {
  Matrix samples(2, 6);
  samples << 1, 2, 3, 4, 5, 6,  //
      1, nan, 3, 4, 5, 6;

  const BodyTake take = body_take(samples, 120);

  EXPECT_TRUE(take.seen(0, 0) && take.seen(0, 1) && take.seen(1, 1));
  EXPECT_FALSE(take.seen(1, 0));
  EXPECT_EQ(take.positions(1, 1), 0);
}

TEST(BodyTake, RefusesColumnsThatAreNoJoints) {
  EXPECT_THROW(body_take(Matrix::Zero(3, 4), 120), ShapeError);
}

TEST(OddFrames, AreTheNearestOddNumber) {
  EXPECT_EQ(odd_frames(0.058, 120), 7);   // 6.96 frames
  EXPECT_EQ(odd_frames(0.092, 120), 11);  // 11.04
  EXPECT_EQ(odd_frames(0.058, 25), 3);    // 1.45, but no fewer than 3
  EXPECT_EQ(odd_frames(0.058, 250), 15);  // 14.5
}

TEST(BodySize, IsTheMedianDistanceFromTheMedianJoint) {
  Matrix samples(1, 9);
  samples << 0, 0, 0, 3, 4, 0, -3, -4, 0;  // median joint 0: distances 0, 5, 5

  EXPECT_DOUBLE_EQ(body_size(body_take(samples, 120)), 5);
}

TEST(Vanished, FindsJointsAtTheOrigin) {
  Matrix samples = test::swinging_limbs(60, 6);
  samples.row(10).segment<3>(6).setZero();

  const Mask lost = vanished(body_take(samples, 120));

  EXPECT_TRUE(lost(10, 2));
  EXPECT_EQ(lost.count(), 1);
}

TEST(Vanished, LeavesAJointThatIsAlwaysAtTheOrigin) {
  Matrix samples = test::swinging_limbs(60, 6);
  samples.middleCols<3>(0).setZero();
  samples.row(10).segment<3>(6).setZero();

  const BodyTake take = body_take(samples, 120);

  EXPECT_EQ(still_joints(take), (std::vector<bool>{true, false, false, false, false, false}));
  EXPECT_EQ(vanished(take).count(), 1);
}

TEST(Vanished, LeavesAJointThatIsAtTheOriginForMostOfTheTime) {
  Matrix samples = test::swinging_limbs(60, 6);
  samples.block<40, 3>(0, 6).setZero();
  EXPECT_FALSE(vanished(body_take(samples, 120)).any());

  samples.block<40, 3>(0, 6) = test::swinging_limbs(60, 6).block<40, 3>(0, 6);
  samples.block<30, 3>(0, 6).setZero();  // half of it
  EXPECT_EQ(vanished(body_take(samples, 120)).count(), 30);
}

TEST(Vanished, LeavesAJointThatMovesToTheOriginAndOn) {
  // At 0.1 a frame through the origin, where it rests for five frames.
  Matrix samples = test::swinging_limbs(60, 6);
  for (Index i = 0; i < 60; ++i) {
    const Index way = i < 30 ? i - 30 : std::max<Index>(0, i - 34);
    samples.row(i).segment<3>(6) << 0.1 * static_cast<double>(way), 0, 0;
  }

  EXPECT_FALSE(vanished(body_take(samples, 120)).any());
}

TEST(Vanished, LeavesThePoseAtTheOriginThatABodyBeginsWith) {
  // Frame 0 has the root at the origin and every bone as long as ever.
  Matrix samples = test::swinging_limbs(60, 6);
  const Eigen::RowVector3d root = samples.row(0).head<3>();
  for (Index j = 0; j < 6; ++j) samples.row(0).segment<3>(3 * j) -= root;

  EXPECT_FALSE(vanished(body_take(samples, 120)).any());
  samples.row(0).segment<3>(3) += root;
  samples.row(0).segment<3>(6) += root;  // neither of its children is where it should be
  EXPECT_EQ(vanished(body_take(samples, 120)).count(), 1);
}

TEST(Vanished, FindsZerosUnderNoise) {
  Matrix samples = test::swinging_limbs(200, 8);
  Random random(3);
  Mask dropped = Mask::Constant(200, 8, false);
  for (Index i = 0; i < 200; ++i)
    for (Index j = 0; j < 8; ++j)
      if (random.uniform() < 0.3) {
        dropped(i, j) = true;
        for (Index c = 0; c < 3; ++c) samples(i, 3 * j + c) = 0.05 * random.normal();
      }

  const Mask lost = vanished(body_take(samples, 120));

  EXPECT_TRUE((lost == dropped).all());
}

TEST(Vanished, TakesNoMotionForLostJoints) {
  const Matrix motion = test::swinging_limbs(200, 8);
  const Matrix centred = motion.rowwise() - motion.colwise().mean();

  EXPECT_FALSE(vanished(body_take(motion, 120)).any());
  EXPECT_FALSE(vanished(body_take(centred, 120)).any());
}

}  // namespace
}  // namespace moclean
