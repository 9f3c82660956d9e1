#include "moclean/motion/skeleton.hpp"

#include <numbers>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using enum Channel;
using Eigen::Vector3d;
using test::largest_difference;

constexpr double degrees = std::numbers::pi / 180;

Matrix row(std::initializer_list<double> values) {
  return Eigen::Map<const Matrix>(values.begin(), 1, static_cast<Index>(values.size()));
}

struct Order {
  std::vector<Channel> channels;
  Vector3d child;
};

class RotationOrder : public testing::TestWithParam<Order> {};

// On paper: a quarter turn takes (x, y, z) to (x, -z, y) about x, to (z, y, -x) about y and to
// (-y, x, z) about z; the last channel acts on the child's offset (1, 2, 3) first.
TEST_P(RotationOrder, TurnsTheChildAsOnPaper) {
  Skeleton skeleton;
  skeleton.bones = {{.name = "root", .channels = GetParam().channels},
                    {.name = "child", .parent = 0, .offset = {1, 2, 3}}};

  const Matrix positions =
      forward_kinematics(skeleton, row({90 * degrees, 90 * degrees, 90 * degrees}));

  const Vector3d& c = GetParam().child;
  EXPECT_LE(largest_difference(positions, row({0, 0, 0, c.x(), c.y(), c.z()})),
            test::tolerance::by_hand(3));
}

INSTANTIATE_TEST_SUITE_P(AllSix, RotationOrder,
                         testing::Values(Order{{rotate_x, rotate_y, rotate_z}, {3, -2, 1}},
                                         Order{{rotate_x, rotate_z, rotate_y}, {-2, 1, 3}},
                                         Order{{rotate_y, rotate_x, rotate_z}, {1, -3, 2}},
                                         Order{{rotate_y, rotate_z, rotate_x}, {2, 1, -3}},
                                         Order{{rotate_z, rotate_x, rotate_y}, {-1, 3, 2}},
                                         Order{{rotate_z, rotate_y, rotate_x}, {3, 2, -1}}));

TEST(ForwardKinematics, AddsUpAnglesAlongAChain) {
  Skeleton arm;
  arm.bones = {{.name = "shoulder", .channels = {rotate_z}},
               {.name = "elbow", .parent = 0, .offset = {2, 0, 0}, .channels = {rotate_z}},
               {.name = "hand", .parent = 1, .offset = {1, 0, 0}}};

  const Matrix positions = forward_kinematics(arm, row({30 * degrees, 60 * degrees}));

  const double x = std::sqrt(3.0);  // elbow at 2 (cos 30, sin 30), hand straight above it
  EXPECT_LE(largest_difference(positions, row({0, 0, 0, x, 1, 0, x, 2, 0})),
            test::tolerance::by_hand(2));
}

TEST(ForwardKinematics, TurnsGrandchildrenByTheProductOfTheirAncestors) {
  Skeleton skeleton;
  skeleton.bones = {{.name = "a", .channels = {rotate_z}},
                    {.name = "b", .parent = 0, .offset = {1, 0, 0}, .channels = {rotate_x}},
                    {.name = "c", .parent = 1, .offset = {0, 1, 0}}};

  const Matrix positions = forward_kinematics(skeleton, row({90 * degrees, 90 * degrees}));

  EXPECT_LE(largest_difference(positions, row({0, 0, 0, 0, 1, 0, 0, 1, 1})),
            test::tolerance::by_hand(1));
}

TEST(ForwardKinematics, AddsTranslationsToTheOffsetBeforeAnyRotation) {
  Skeleton skeleton;
  skeleton.bones = {
      {.name = "root", .offset = {1, 1, 1}, .channels = {rotate_z, translate_x, translate_z}},
      {.name = "child", .parent = 0, .offset = {1, 0, 0}, .channels = {translate_y}}};

  const Matrix positions = forward_kinematics(skeleton, row({90 * degrees, 10, 20, 5}));

  EXPECT_LE(largest_difference(positions, row({11, 1, 21, 11 - 5, 1 + 1, 21})),
            test::tolerance::by_hand(21));
}

// The motion turns about x of a frame that is turned by a quarter about z, hence about y, which
// takes (1, 0, 0) to (0, 0, -1). The child hangs on the far end and turns along.
TEST(ForwardKinematics, TurnsAnAcclaimBoneInItsOwnFrame) {
  const Eigen::Matrix3d axis =
      Eigen::AngleAxisd(90 * degrees, Vector3d::UnitZ()).toRotationMatrix();
  Skeleton skeleton;
  skeleton.bones = {{.name = "bone",
                     .before = axis,
                     .channels = {rotate_x},
                     .after = axis.transpose(),
                     .tail = {1, 0, 0}},
                    {.name = "next", .parent = 0, .tail = {2, 0, 0}}};

  const Matrix positions = forward_kinematics(skeleton, row({90 * degrees}));

  EXPECT_LE(largest_difference(positions, row({0, 0, -1, 0, 0, -3})), test::tolerance::by_hand(3));
}

TEST(ForwardKinematics, KeepsSeveralRootsApart) {
  Skeleton skeleton;
  skeleton.bones = {{.name = "a", .channels = {translate_x}},
                    {.name = "b", .offset = {0, 7, 0}, .channels = {translate_x}}};

  const Matrix positions = forward_kinematics(skeleton, row({1, 2}));

  EXPECT_EQ(positions, row({1, 0, 0, 2, 7, 0}));
}

TEST(ForwardKinematics, PlacesAFrameWhateverFramesAreBesideIt) {
  Skeleton skeleton;
  skeleton.bones = {{.name = "root", .channels = {translate_x, rotate_z, rotate_y}},
                    {.name = "child", .parent = 0, .channels = {rotate_x}, .tail = {1, 2, 3}},
                    {.name = "rigid", .parent = 1, .offset = {0, 4, 0}}};
  const Matrix motion = test::random_matrix(11, 4, 1);

  const Matrix together = forward_kinematics(skeleton, motion);

  for (Index f = 0; f < motion.rows(); ++f)
    EXPECT_TRUE(test::same_bits(together.row(f), forward_kinematics(skeleton, motion.row(f)))) << f;
}

TEST(ForwardKinematics, RejectsMotionOfAnotherWidth) {
  Skeleton skeleton;
  skeleton.bones = {{.name = "a", .channels = {translate_x}}};

  EXPECT_THROW(forward_kinematics(skeleton, row({1, 2})), ShapeError);
}

TEST(ForwardKinematics, RejectsAParentThatComesLater) {
  Skeleton skeleton;
  skeleton.bones = {{.name = "a", .parent = 1}, {.name = "b"}};

  EXPECT_THROW(forward_kinematics(skeleton, Matrix(1, 0)), ShapeError);
}

}  // namespace
}  // namespace moclean
