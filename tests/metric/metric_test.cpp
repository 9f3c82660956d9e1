#include "moclean/metric/metric.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;
using testing::ThrowsMessage;

// Two frames of one joint and one single channel.
Recording clip_of(const Matrix& samples) {
  return {.samples = samples, .columns = {"hip.x", "hip.y", "hip.z", "force"}, .unit = "cm"};
}

Matrix truth() { return Matrix{{1, 2, 3, 4}, {5, 6, 7, 8}}; }

TEST(Compare, GivesTheFiguresOfACalculationOnPaper) {
  const Matrix estimate{{1, 2, 3, 4}, {5, 9, 3, 10}};  // differences 0 0 0 0, 0 3 -4 2

  const Comparison result = compare(clip_of(truth()), clip_of(estimate));

  EXPECT_NEAR(result.fd, std::sqrt(29.0 / 8), test::tolerance::by_hand(2));
  EXPECT_EQ(result.changed, 3);
  EXPECT_NEAR(result.rmse_changed, std::sqrt(29.0 / 3), test::tolerance::by_hand(4));
  EXPECT_EQ(result.largest, 4);
  EXPECT_EQ(result.not_compared, 0);
}

TEST(Compare, BreaksTheErrorDownByJoint) {
  const Matrix estimate{{1, 2, 3, 4}, {5, 9, 3, 10}};

  const Comparison result = compare(clip_of(truth()), clip_of(estimate));

  ASSERT_EQ(result.joints.size(), 2u);
  EXPECT_EQ(result.joints[0].name, "hip");
  EXPECT_NEAR(result.joints[0].rmse, std::sqrt(25.0 / 6), test::tolerance::by_hand(3));
  EXPECT_EQ(result.joints[0].largest, 4);
  EXPECT_EQ(result.joints[0].largest_frame, 1);
  EXPECT_EQ(result.joints[1].name, "force");
  EXPECT_NEAR(result.joints[1].rmse, std::sqrt(4.0 / 2), test::tolerance::by_hand(2));
  EXPECT_EQ(result.worst_joint, "hip");
}

TEST(Compare, NamesTheJointOfLargestRmseNotOfLargestEntry) {
  const Matrix estimate{{1, 2, 3, 7}, {5, 6, 11, 11}};  // hip: one 4 in six, force: 3 and 3

  EXPECT_EQ(compare(clip_of(truth()), clip_of(estimate)).worst_joint, "force");
}

TEST(Compare, FindsNoDifferenceBetweenEqualClips) {
  const Comparison result = compare(clip_of(truth()), clip_of(truth()));

  EXPECT_EQ(result.fd, 0);
  EXPECT_EQ(result.changed, 0);
  EXPECT_EQ(result.rmse_changed, 0);
  EXPECT_EQ(result.largest, 0);
  EXPECT_EQ(result.worst_joint, "");
}

TEST(Compare, LeavesNaNOutOfEveryFigureAndCountsIt) {
  const Matrix seen{{1, nan, 3, 4}, {5, 6, 7, nan}};
  const Matrix estimate{{1, nan, 3, 4}, {5, 9, nan, 8}};

  const Comparison result = compare(clip_of(seen), clip_of(estimate));

  EXPECT_EQ(result.not_compared, 3);
  EXPECT_NEAR(result.fd, std::sqrt(9.0 / 5), test::tolerance::by_hand(2));
  EXPECT_EQ(result.changed, 1);
  EXPECT_NEAR(result.joints[0].rmse, std::sqrt(9.0 / 4), test::tolerance::by_hand(2));
  EXPECT_EQ(result.joints[1].rmse, 0);
}

TEST(Compare, RefusesDifferentShapes) {
  Recording longer = clip_of(Matrix::Zero(3, 4));

  EXPECT_THAT([&] { compare(clip_of(truth()), longer); },
              ThrowsMessage<ShapeError>("cannot compare 2 frames x 4 columns with 3 frames x 4 "
                                        "columns: the shapes differ"));
}

TEST(Compare, RefusesClipsWithNothingInCommon) {
  const Recording unseen = clip_of(Matrix::Constant(2, 4, nan));

  EXPECT_THAT([&] { compare(clip_of(truth()), unseen); },
              ThrowsMessage<ShapeError>("nothing to compare: no entry is observed in both clips"));
}

TEST(FrobeniusDistance, IsTheRootMeanSquareDifference) {
  EXPECT_EQ(frobenius_distance(Matrix{{0, 0}, {0, 0}}, Matrix{{1, -1}, {1, 1}}), 1);
  EXPECT_EQ(frobenius_distance(Matrix{{0, 0}, {0, 0}}, Matrix{{4, 0}, {0, 0}}), 2);
  EXPECT_EQ(frobenius_distance(Matrix{{0, nan}}, Matrix{{3, 1}}), 3);
}

}  // namespace
}  // namespace moclean
