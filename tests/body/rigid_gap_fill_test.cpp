// Joints carried through gaps by their neighbours.
#include "moclean/body/rigid_gap_fill.hpp"

#include <gtest/gtest.h>

namespace moclean {
namespace {

// Four joints, two frames; the cloud turns by 90 degrees about z and moves by (10, 0, 0).
BodyTake quarter_turn() {
  Matrix p(2, 12);
  p << 0, 0, 0, 1, 0, 0, 0, 2, 0, 1, 1, 3,  //
      10, 0, 0, 10, 1, 0, 8, 0, 0, 9, 1, 3;
  return body_take(p, 100);
}

const Neighbours three = {{0, 1}, {1, 2}, {2, 0.5}};

TEST(RigidMotion, IsThatOfARigidBody) {
  const RigidMotion motion = rigid_motion(quarter_turn(), three, 0, 1);

  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_LE((motion.rotation - turn).norm(), 1e-12);
  EXPECT_LE((motion.moved({1, 1, 3}) - Eigen::RowVector3d(9, 1, 3)).norm(), 1e-12);
  EXPECT_LE((motion.moved_back({9, 1, 3}) - Eigen::RowVector3d(1, 1, 3)).norm(), 1e-12);
}

TEST(RigidGapFill, GoesAlongFromTheOneEdge) {
  const Matrix found = rigid_gap_fill(quarter_turn(), three, {3, 1, 2, true, false}, {1});

  EXPECT_LE((found - Eigen::RowVector3d(9, 1, 3)).norm(), 1e-12);
}

TEST(Held, IsOnTheLineBetweenTheEdges) {
  Matrix p = Matrix::Zero(5, 3);
  p.row(0) << 0, 4, 8;
  p.row(4) << 8, 4, 0;

  const Matrix found = held(body_take(p, 100), {0, 1, 4, true, true}, {1, 2});

  EXPECT_LE((found.row(0) - Eigen::RowVector3d(2, 4, 6)).norm(), 1e-12);
  EXPECT_LE((found.row(1) - Eigen::RowVector3d(4, 4, 4)).norm(), 1e-12);
}

}  // namespace
}  // namespace moclean
