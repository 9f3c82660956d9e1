// Joints carried through gaps by their neighbours.
#include "moclean/body/carried.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace moclean {
namespace {

constexpr Index frames = 300, joints = 7;
constexpr Index hidden = 2;  // the joint with the gap
constexpr double steady = 1e-3;

// A rigid cloud of markers that turns about two axes and travels.
Matrix turning_cloud() {
  Matrix p(frames, 3 * joints);
  for (Index i = 0; i < frames; ++i) {
    const double t = static_cast<double>(i) / 60;
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(1.5 * std::sin(t), Eigen::Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(0.9 * t, Eigen::Vector3d::UnitZ()))
                                     .toRotationMatrix();
    for (Index j = 0; j < joints; ++j) {
      const auto k = static_cast<double>(j);
      const Eigen::Vector3d corner(std::cos(2 * k), std::sin(3 * k), std::cos(5 * k + 1));
      p.row(i).segment<3>(3 * j) =
          (turn * corner).transpose() + Eigen::RowVector3d(t, 2 * std::sin(t), 3);
    }
  }
  return p;
}

// Adds a sine of the frame to the joint with the gap: skin that slides.
Matrix sliding(Matrix samples, double amplitude) {
  for (Index i = 0; i < samples.rows(); ++i)
    samples(i, 3 * hidden) += amplitude * std::sin(0.1 * static_cast<double>(i));
  return samples;
}

Carried carry_over(Matrix samples, Index first, Index last) {
  samples.middleRows(first, last - first)
      .middleCols(3 * hidden, 3)
      .setConstant(std::numeric_limits<double>::quiet_NaN());
  return carry(body_take(samples, 120), steady, 8);
}

double largest_miss(const Carried& carried, const Matrix& truth, Index first, Index last) {
  return (carried.positions - truth)
      .middleRows(first, last - first)
      .middleCols(3 * hidden, 3)
      .cwiseAbs()
      .maxCoeff();
}

TEST(Carry, IsExactInARigidBody) {
  const Matrix truth = turning_cloud();

  const Carried carried = carry_over(truth, 100, 160);

  EXPECT_LE(largest_miss(carried, truth, 100, 160), 1e-9);
  EXPECT_LE(carried.variance.col(hidden).segment(100, 60).maxCoeff(), 1e-18);
}

TEST(Carry, HasOneSideAtTheEndsOfATake) {
  const Matrix truth = turning_cloud();

  EXPECT_LE(largest_miss(carry_over(truth, 0, 40), truth, 0, 40), 1e-9);
  EXPECT_LE(largest_miss(carry_over(truth, 260, frames), truth, 260, frames), 1e-9);
}

TEST(Carry, SaysNothingOfWhatIsSeen) {
  const Carried carried = carry_over(turning_cloud(), 100, 160);

  EXPECT_EQ(carried.variance.array().isFinite().count(), 60);
  EXPECT_EQ(carried.positions.topRows(100).norm(), 0);
}

TEST(Carry, KnowsHowFarOffItIs) {
  constexpr double amplitude = 0.05;
  const Matrix truth = sliding(turning_cloud(), amplitude);

  double squares = 0, variances = 0;
  for (const Index first : {60, 90, 120, 150, 180, 210}) {
    const Carried carried = carry_over(truth, first, first + 40);
    squares +=
        (carried.positions - truth).middleRows(first, 40).middleCols(3 * hidden, 3).squaredNorm() /
        3;
    variances += carried.variance.col(hidden).segment(first, 40).sum();
  }

  EXPECT_GT(squares, 0);
  EXPECT_GT(variances, 0.5 * squares);
  EXPECT_LT(variances, 4 * squares);
}

TEST(Carry, LeavesShortGapsAlone) { EXPECT_TRUE(carry_over(turning_cloud(), 100, 107).empty()); }

TEST(Carry, NeedsThreeNeighboursThatAreSeen) {
  Matrix samples = turning_cloud();
  for (const Index j : {0, 1, 3, 4})
    samples.row(120).segment<3>(3 * j).setConstant(std::numeric_limits<double>::quiet_NaN());

  const Carried carried = carry_over(samples, 100, 160);

  EXPECT_FALSE(carried.variance.array().isFinite().any());
}

TEST(Carry, NeedsTrialsOfTheSameLength) {
  const Carried carried = carry_over(turning_cloud(), 10, 200);

  EXPECT_FALSE(carried.variance.array().isFinite().any());
}

}  // namespace
}  // namespace moclean
