#include "moclean/motion/euler_angles.hpp"

#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "moclean/core/random.hpp"

#include "support/tolerance.hpp"

namespace moclean {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

using std::numbers::pi;

Matrix3d rotation(const std::array<int, 3>& axes, const Vector3d& angles) {
  Matrix3d product = Matrix3d::Identity();
  for (std::size_t i = 0; i < 3; ++i)
    product =
        product * Eigen::AngleAxisd(angles[static_cast<Eigen::Index>(i)], Vector3d::Unit(axes[i]))
                      .toRotationMatrix();
  return product;
}

class EulerOrder : public testing::TestWithParam<std::array<int, 3>> {};

TEST_P(EulerOrder, GivesBackAnglesNearTheReference) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Vector3d angles(10 * random.normal(), 10 * random.normal(), 10 * random.normal());
    const Vector3d reference = angles + Vector3d(0.1, -0.1, 0.1);
    if (std::abs(std::cos(angles[1])) < 0.2) continue;  // near the lock both solutions are near

    const Vector3d found = euler_angles(rotation(GetParam(), angles), GetParam(), reference);

    EXPECT_LE((found - angles).norm(), test::tolerance::by_hand(100));
  }
}

TEST_P(EulerOrder, GivesTheSameRotationWhereTheAxesLock) {
  for (const double slack : {0., 1e-12, -1e-9, 1e-6})
    for (const double b : {pi / 2 + slack, -pi / 2 - slack}) {
      const Matrix3d wanted = rotation(GetParam(), {0.3, b, -0.4});

      const Vector3d found = euler_angles(wanted, GetParam(), {0.5, b, 0.1});

      EXPECT_LE((rotation(GetParam(), found) - wanted).norm(), 1e-8) << slack;
    }
}

INSTANTIATE_TEST_SUITE_P(AllSix, EulerOrder,
                         testing::Values(std::array{0, 1, 2}, std::array{0, 2, 1},
                                         std::array{1, 0, 2}, std::array{1, 2, 0},
                                         std::array{2, 0, 1}, std::array{2, 1, 0}));

TEST(NearestAngles, GoesTheOtherWayRoundTheMiddleAxis) {
  const Vector3d found = nearest_angles({0.1, 0.2, 0.3}, {pi, pi, 3 * pi});

  EXPECT_LE((found - Vector3d(0.1 + pi, pi - 0.2, 0.3 + 3 * pi)).norm(),
            test::tolerance::by_hand(10));
}

}  // namespace
}  // namespace moclean
