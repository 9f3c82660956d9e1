#include "moclean/denoise/change.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/nan.hpp"

namespace moclean {
namespace {

using test::nan;

// Two frames of the joints a, b and c, and a weight; 14 samples.
Recording small_take() {
  Recording take{
      .samples = Matrix(2, 10),
      .columns = {"a.x", "a.y", "a.z", "b.x", "b.y", "b.z", "c.x", "c.y", "c.z", "weight"},
      .frame_rate = 60,
      .unit = "mm"};
  take.samples << 0, 0, 9, 30, 40, 0, -30, -40, 0, 1,  //
      0, 0, 10, 30, nan, 1, -30, -41, 0, 2;
  return take;
}

Denoised unchanged(const Recording& take) {
  return {.motion = take.samples,
          .outliers = Matrix::Zero(take.samples.rows(), take.samples.cols()),
          .trusted = !take.samples.array().isNaN()};
}

Change change_of(const Recording& take, const Denoised& result) {
  return change_of(take, result.motion, count_status(take, result, trusted_samples(take, result)));
}

TEST(ChangeOf, NothingIsNothing) {
  const Change change = change_of(small_take(), unchanged(small_take()));

  EXPECT_EQ(change.corrected, 0);
  EXPECT_EQ(change.filled, 0);
  EXPECT_EQ(change.largest.distance, 0);
  EXPECT_EQ(change.largest.joint, "");
  EXPECT_EQ(change.largest_share(), 0);
}

TEST(ChangeOf, CountsAndFindsTheFarthestJoint) {
  Denoised result = unchanged(small_take());
  result.motion(1, 3) = 33;  // b.x by 3
  result.motion(1, 4) = 90;  // b.y was missing
  result.motion(1, 5) = 5;   // b.z by 4
  result.motion(0, 6) = -26;
  (*result.trusted)(1, 3) = (*result.trusted)(1, 5) = false;

  const Change change = change_of(small_take(), result);

  EXPECT_EQ(change.corrected, 2. / 20);
  EXPECT_EQ(change.filled, 1. / 20);
  EXPECT_EQ(change.largest.distance, 5);
  EXPECT_EQ(change.largest.joint, "b");
  EXPECT_EQ(change.largest.frame, 1);
}

TEST(ChangeOf, ComparesWithTheBodysSize) {
  Recording take = small_take();
  take.samples.row(1) = take.samples.row(0);
  take.samples(1, 0) = 0.5;  // or nothing would move
  take.samples(1, 3) = 30.5;
  take.samples(1, 6) = -30.5;
  Denoised result = unchanged(take);
  result.motion(0, 9) = 6;  // the weight by 5

  const Change change = change_of(take, result);

  // Distances from the middle joint (0 0 0): 9, 50, 50 and 9, 50.3, 50.4 about (0.5 0 0).
  EXPECT_NEAR(change.body_size, 50, 0.5);
  EXPECT_EQ(change.largest_share(), 5 / change.body_size);
}

TEST(ChangeOf, TakesALostJointForNoneThatMoved) {
  Recording take = small_take();
  take.samples.row(0).head(3).setZero();
  Denoised result = unchanged(take);
  result.motion(0, 2) = 9;
  (*result.trusted).row(0).head(3).setConstant(false);

  const Change change = change_of(take, result);

  EXPECT_EQ(change.corrected, 3. / 20);
  EXPECT_EQ(change.largest.distance, 0);
  EXPECT_EQ(change.largest.joint, "");
}

}  // namespace
}  // namespace moclean
