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

  std::vector<Matrix> found;
  PostureRegression(postures).predict({0, 4, 6, true, false}, postures.others({4, 5}), {{1e-12, 1}},
                                      found);

  EXPECT_NEAR(found.front()(0, 0), 9, 1e-6);
  EXPECT_NEAR(found.front()(1, 0), 11, 1e-6);
}

// By hand: x = -1.5, -.5, .5, 1.5, y = 2 x, G = 5, its mean over three coordinates 5/3; with a
// ridge of 3 the slope is 10 / (5 + 3 5/3) = 1 about the means 1.5 and 4.
TEST(PostureRegression, ShrinksByTheRidge) {
  const BodyTake take = line();
  const LocalPostures postures(take, 0, {}, {1}, {0, 1, 2, 3});

  std::vector<Matrix> found;
  PostureRegression(postures).predict({0, 4, 6, true, false}, postures.others({4}), {{3, 1}},
                                      found);

  EXPECT_NEAR(found.front()(0, 0), 4 + 2.5, 1e-12);
}

TEST(PostureRegression, DoesNotLearnFromWhatIsLeftOut) {
  BodyTake take = line();
  take.positions(2, 0) = 1000;
  const LocalPostures postures(take, 0, {}, {1}, {0, 1, 2, 3, 4, 5});

  std::vector<Matrix> found;
  PostureRegression(postures).predict({0, 2, 3}, postures.others({2}), {{1e-12, 1}}, found);

  EXPECT_NEAR(found.front()(0, 0), 5, 1e-6);
}

// Differences know nothing of where the joint is, only of how it moves.
TEST(PostureRegression, WithALagLearnsHowItMoves) {
  BodyTake take = line();
  take.positions.col(0).tail(3).array() += 50;  // a jump, seen by the differences across it only
  const LocalPostures postures(take, 0, {}, {1}, {0, 1, 2, 3, 4, 5});

  std::vector<Matrix> found;
  PostureRegression(postures, 1).predict({0, 3, 4}, postures.others({4, 5}), {{1e-12, 1}}, found);

  EXPECT_NEAR(found.front()(1, 0) - found.front()(0, 0), 2, 1e-6);
}

// The first of two features tells nothing: a regression on it alone predicts the mean.
TEST(PostureRegression, UsesTheFirstFeatures) {
  BodyTake take = line();
  Matrix p = Matrix::Zero(6, 9);
  p.leftCols(3) = take.positions.leftCols(3);
  p.rightCols(3) = take.positions.rightCols(3);
  take = body_take(p, 100);
  const LocalPostures postures(take, 0, {}, {1, 2}, {0, 1, 2, 3});

  std::vector<Matrix> found;
  PostureRegression(postures).predict({0, 4, 6, true, false}, postures.others({4}),
                                      {{1e-12, 1}, {1e-12, 2}}, found);

  EXPECT_NEAR(found[0](0, 0), 4, 1e-6);
  EXPECT_NEAR(found[1](0, 0), 9, 1e-6);
}

// Carriers that shift and turn by a right angle take the joint along.
TEST(LocalPostures, CarryFromTheEdges) {
  Matrix p(3, 12);
  for (const Index i : {0, 2}) p.row(i) << 5, 6, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3;
  p.row(1) << 0, 0, 0, 10, 21, 0, 8, 20, 0, 10, 20, 3;
  const BodyTake take = body_take(p, 100);
  const LocalPostures postures(take, 0, {{1, 1}, {2, 1}, {3, 1}}, {1}, {0});
  const Frames some = {0, 2, 1};

  const Matrix found = postures.predicted({0, 1, 2}, some, postures.others(some));

  EXPECT_LE((found.row(2) - Eigen::RowVector3d(4, 25, 0)).norm(), 1e-9);
}

}  // namespace
}  // namespace moclean
