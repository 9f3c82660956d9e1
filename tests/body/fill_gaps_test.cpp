// Gaps filled by the body.
#include "moclean/body/fill_gaps.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "support/nan.hpp"

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

Matrix without(Matrix samples, Index joint, Index first, Index last) {
  samples.middleRows(first, last - first).middleCols(3 * joint, 3).setConstant(test::nan);
  return samples;
}

Fills filled(const Matrix& samples) { return fill_gaps(body_take(samples, 120), steady, 8); }

Fills fill_between(const Matrix& samples, Index first, Index last) {
  return filled(without(samples, hidden, first, last));
}

double largest_miss(const Fills& fills, const Matrix& truth, Index first, Index last) {
  return (fills.positions - truth)
      .middleRows(first, last - first)
      .middleCols(3 * hidden, 3)
      .cwiseAbs()
      .maxCoeff();
}

TEST(FillGaps, IsExactInARigidBody) {
  const Matrix truth = turning_cloud();

  const Fills fills = fill_between(truth, 100, 160);

  EXPECT_LE(largest_miss(fills, truth, 100, 160), 1e-6);
  EXPECT_LE(fills.variance.col(hidden).segment(100, 60).maxCoeff(), 1e-11);
}

TEST(FillGaps, HasOneSideAtTheEndsOfATake) {
  const Matrix truth = turning_cloud();

  EXPECT_LE(largest_miss(fill_between(truth, 0, 40), truth, 0, 40), 1e-6);
  EXPECT_LE(largest_miss(fill_between(truth, 260, frames), truth, 260, frames), 1e-6);
}

// No joint is at a constant distance of the hidden one, which is the middle of two others.
TEST(FillGaps, LearnsALinearRelation) {
  Matrix truth = turning_cloud();
  for (Index i = 0; i < frames; ++i) {
    const double t = static_cast<double>(i) / 20;
    truth.row(i).segment<3>(15) +=
        Eigen::RowVector3d(std::sin(t), std::cos(3 * t), std::sin(2 * t));
    truth.row(i).segment<3>(18) += Eigen::RowVector3d(std::cos(2 * t), std::sin(t), std::cos(t));
    truth.row(i).segment<3>(3 * hidden) =
        (truth.row(i).segment<3>(15) + truth.row(i).segment<3>(18)) / 2;
  }

  const Fills fills = fill_between(truth, 100, 160);

  EXPECT_LE(largest_miss(fills, truth, 100, 160), 1e-3);
  EXPECT_LE(fills.variance.col(hidden).segment(100, 60).maxCoeff(), 1e-5);
}

TEST(FillGaps, SaysNothingOfWhatIsSeen) {
  const Fills fills = fill_between(turning_cloud(), 100, 160);

  EXPECT_EQ(fills.variance.array().isFinite().count(), 60);
  EXPECT_EQ(fills.positions.topRows(100).norm(), 0);
}

TEST(FillGaps, KnowsHowFarOffItIs) {
  const Matrix truth = sliding(turning_cloud(), 0.05);

  double squares = 0, variances = 0;
  for (const Index first : {60, 90, 120, 150, 180, 210}) {
    const Fills fills = fill_between(truth, first, first + 40);
    squares +=
        (fills.positions - truth).middleRows(first, 40).middleCols(3 * hidden, 3).squaredNorm() / 3;
    variances += fills.variance.col(hidden).segment(first, 40).sum();
  }

  EXPECT_GT(squares, 0);
  EXPECT_GT(variances, 0.5 * squares);
  EXPECT_LT(variances, 6 * squares);
}

// Another pose than any that the regression could learn from.
TEST(FillGaps, IsLessSureInAPostureUnlikeTheOthers) {
  Matrix usual = sliding(turning_cloud(), 0.05), unusual = usual;
  for (Index i = 140; i < 150; ++i) unusual(i, 15) += 3;

  const double sure = fill_between(usual, 120, 170).variance(145, hidden);

  EXPECT_GT(fill_between(unusual, 120, 170).variance(145, hidden), 2 * sure);
}

TEST(FillGaps, ScalesWithTheData) {
  const Matrix samples = without(sliding(turning_cloud(), 0.05), hidden, 100, 160);

  const Fills once = filled(samples);
  const Fills thousandfold = fill_gaps(body_take(1024 * samples, 120), 1024 * steady, 8);

  EXPECT_LE((thousandfold.positions / 1024 - once.positions).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(thousandfold.variance(130, hidden) / 1024 / 1024, once.variance(130, hidden),
              1e-6 * once.variance(130, hidden));
}

TEST(FillGaps, LeavesShortGapsAlone) {
  EXPECT_TRUE(fill_between(turning_cloud(), 100, 107).empty());
}

// With nobody to go by, a joint is held on the line between the edges, and little is known.
TEST(FillGaps, HoldsAJointThatHasNoNeighbours) {
  const Matrix truth = turning_cloud();
  Matrix samples = without(truth, hidden, 100, 159);
  for (const Index j : {0, 1, 3, 4, 5}) samples = without(samples, j, 120, 128);

  const Fills fills = filled(samples);

  const auto at = [&](Index i) { return truth.row(i).segment<3>(3 * hidden); };
  EXPECT_LE((fills.positions.row(129).segment<3>(3 * hidden) - (at(99) + at(159)) / 2).norm(),
            1e-9);
  EXPECT_GT(fills.variance(129, hidden), 1e-3);
}

TEST(FillGaps, PromisesNothingWhereTrialsCouldNotGoWrong) {
  // A marker that lies still, to the last bit, until it is lost and found elsewhere.
  Matrix samples = turning_cloud();
  for (Index i = 0; i < frames; ++i) {
    samples.row(i).segment<3>(3 * hidden) << 1, 2, 3;
    if (i >= 160) samples.row(i).segment<3>(3 * hidden) << 1.5, 2, 2.5;
  }
  const Fills fills = filled(without(samples, hidden, 100, 160));

  const auto variance = fills.variance.col(hidden).segment(100, 60);
  EXPECT_TRUE((variance.array() > 0).all());
  for (Index i = 100; i < 160; ++i)
    if (std::isfinite(fills.variance(i, hidden))) {
      EXPECT_LT(fills.variance(i, hidden), 100);
      EXPECT_TRUE(fills.positions.row(i).segment<3>(3 * hidden).allFinite());
    }
}

TEST(FillGaps, TakesShorterTrialsForALongGap) {
  const Fills fills = fill_between(turning_cloud(), 10, 200);

  EXPECT_TRUE(fills.variance.col(hidden).segment(10, 190).array().isFinite().all());
}

TEST(FillGaps, KnowsNothingOfAJointSeenInAFewFrames) {
  const Matrix samples = without(without(turning_cloud(), hidden, 0, 100), hidden, 105, frames);

  const Fills fills = filled(samples);

  EXPECT_FALSE(fills.variance.array().isFinite().any());
}

}  // namespace
}  // namespace moclean
