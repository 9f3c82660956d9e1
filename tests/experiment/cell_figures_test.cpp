// Which columns are measured.

#include <cmath>

#include <gtest/gtest.h>

#include "moclean/experiment/run_cells.hpp"

#include "experiment/small_experiment.hpp"

namespace moclean::test {
namespace {

// Four joints in a row, 1 apart, at rest for three frames.
ExperimentTake row_of_joints() {
  ExperimentTake take{.name = "row", .label = "row", .file = {}, .clip = {}, .excluded = {}};
  take.clip.samples = Matrix::Zero(3, 12);
  for (const char* joint : {"Hips", "Arm", "LeftHand", "Head"})
    for (const char* axis : {".x", ".y", ".z"})
      take.clip.columns.push_back(std::string(joint) + axis);
  for (Index j = 0; j < 4; ++j) take.clip.samples.col(3 * j).setConstant(static_cast<double>(j));
  take.parents = {-1, 0, 1, 0};
  return take;
}

Denoised as_it_is(const Recording& clip) {
  Denoised same;
  same.motion = same.outliers = clip.samples;
  return same;
}

class CellFigures : public ::testing::Test {
 protected:
  double figure(const char* name) {
    const auto values = cell_figures(take_, touched_, estimate_);
    const auto found = values.find(name);
    return found == values.end() ? -1 : found->second;
  }

  ExperimentTake take_ = row_of_joints();
  Mask touched_ = Mask::Constant(3, 12, false);
  Denoised estimate_ = as_it_is(take_.clip);
};

TEST_F(CellFigures, LeaveOutExcludedJoints) {
  estimate_.motion.col(6).array() += 2;  // the hand, out of its place
  estimate_.motion.col(10).array() += 3;
  touched_.col(6).setConstant(true);

  EXPECT_DOUBLE_EQ(figure("fd"), std::sqrt((4.0 + 9.0) / 12));
  EXPECT_DOUBLE_EQ(figure("rmse_touched"), 2);
  EXPECT_DOUBLE_EQ(figure("bone_length"), (2 + std::sqrt(9.0 + 9.0) - 3) / 3);

  take_.excluded = {"HAND"};
  EXPECT_DOUBLE_EQ(figure("fd"), std::sqrt(9.0 / 9));
  EXPECT_TRUE(std::isnan(figure("rmse_touched")));
  EXPECT_DOUBLE_EQ(figure("bone_length"), (std::sqrt(9.0 + 9.0) - 3) / 2);
  EXPECT_DOUBLE_EQ(figure("position"), 1);
}

TEST_F(CellFigures, AJointWhoseParentIsLeftOutHasNoBone) {
  take_.excluded = {"arm"};
  estimate_.motion.col(6).array() += 2;

  EXPECT_DOUBLE_EQ(figure("bone_length"), 0);
}

TEST_F(CellFigures, SayHowMuchIsMissing) {
  estimate_.motion.block(0, 0, 2, 3).setConstant(std::nan(""));

  EXPECT_DOUBLE_EQ(figure("missing"), 6.0 / 36);
  EXPECT_DOUBLE_EQ(figure("fd"), 0);

  estimate_.motion.setConstant(std::nan(""));
  EXPECT_DOUBLE_EQ(figure("missing"), 1);
  EXPECT_DOUBLE_EQ(figure("fd"), -1);
}

TEST_F(CellFigures, HaveNoBonesWithoutASkeleton) {
  take_.parents.clear();

  EXPECT_DOUBLE_EQ(figure("bone_length"), -1);
}

}  // namespace
}  // namespace moclean::test
