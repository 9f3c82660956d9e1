// Joints predicted from the posture.
#include "moclean/body/posture_regression.hpp"

#include <gtest/gtest.h>

namespace moclean {
namespace {

// One feature on a line, the joint at twice its place plus 1; the feature returns in the end.
BodyTake line() {
  Matrix p = Matrix::Zero(6, 6);
  p.col(3) << 0, 1, 2, 3, 4, 5;
  p.col(0) = 2 * p.col(3).array() + 1;
  return body_take(p, 100);
}

TEST(PostureRegression, FindsALinearRelation) {
  const BodyTake take = line();
  const LocalPostures postures(take, 0, {}, {1}, {0, 1, 2, 3});

  Candidates found;
  PostureRegression(postures, 1).predict({0, 4, 6, true, false}, {4, 5}, {1e-12}, found);

  EXPECT_NEAR(found.positions.front()(0, 0), 9, 1e-6);
  EXPECT_NEAR(found.positions.front()(1, 0), 11, 1e-6);
}

// By hand: x = -1.5, -.5, .5, 1.5, y = 2 x, G = 5, its mean over three coordinates 5/3; with a
// ridge of 3 the slope is 10 / (5 + 3 5/3) = 1 about the means 1.5 and 4.
TEST(PostureRegression, ShrinksByTheRidge) {
  const BodyTake take = line();
  const LocalPostures postures(take, 0, {}, {1}, {0, 1, 2, 3});

  Candidates found;
  PostureRegression(postures, 1).predict({0, 4, 6, true, false}, {4}, {3}, found);

  EXPECT_NEAR(found.positions.front()(0, 0), 4 + 2.5, 1e-12);
}

TEST(PostureRegression, DoesNotLearnFromWhatIsLeftOut) {
  BodyTake take = line();
  take.positions(2, 0) = 1000;
  const LocalPostures postures(take, 0, {}, {1}, {0, 1, 2, 3, 4, 5});

  Candidates found;
  PostureRegression(postures, 1).predict({0, 2, 3}, {2}, {1e-12}, found);

  EXPECT_NEAR(found.positions.front()(0, 0), 5, 1e-6);
}

// Differences know nothing of where the joint is, only of how it moves.
TEST(PostureRegression, WithALagLearnsHowItMoves) {
  BodyTake take = line();
  take.positions.col(0).tail(3).array() += 50;  // a jump, seen by the differences across it only
  const LocalPostures postures(take, 0, {}, {1}, {0, 1, 2, 3, 4, 5});

  Candidates found;
  PostureRegression(postures, 1, 1).predict({0, 3, 4}, {4, 5}, {1e-12}, found);

  EXPECT_NEAR(found.positions.front()(1, 0) - found.positions.front()(0, 0), 2, 1e-6);
}

TEST(PostureRegression, KnowsAPostureUnlikeTheOthers) {
  BodyTake take = line();
  take.positions(5, 3) = 50;
  const LocalPostures postures(take, 0, {}, {1}, {0, 1, 2, 3});

  Candidates found;
  PostureRegression(postures, 1).predict({0, 4, 6, true, false}, {1, 2, 5}, {1e-3}, found);

  EXPECT_LT(found.unlikeness(0), 2);
  EXPECT_LT(found.unlikeness(1), 2);
  EXPECT_GT(found.unlikeness(2), 100);
}

}  // namespace
}  // namespace moclean
