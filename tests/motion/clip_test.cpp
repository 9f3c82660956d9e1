#include "moclean/motion/clip.hpp"

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::FieldsAre;

Clip clip_with(std::vector<std::string> columns, Index frames = 1) {
  Clip clip;
  clip.samples = Matrix::Zero(frames, static_cast<Index>(columns.size()));
  clip.columns = std::move(columns);
  return clip;
}

TEST(Joints, GroupThreeNeighboursOfOneName) {
  const Clip clip = clip_with({"hip.x", "hip.y", "hip.z", "knee.x", "knee.y", "knee.z"});

  EXPECT_THAT(joints(clip), ElementsAre(FieldsAre("hip", 0, 3), FieldsAre("knee", 3, 3)));
}

TEST(Joints, LeaveOtherColumnsAlone) {
  const Clip clip = clip_with({"force", "hip.x", "hip.y", "hip.z", "a.x", "a.y", "b.z", "c.x"});

  EXPECT_THAT(joints(clip),
              ElementsAre(FieldsAre("force", 0, 1), FieldsAre("hip", 1, 3), FieldsAre("a.x", 4, 1),
                          FieldsAre("a.y", 5, 1), FieldsAre("b.z", 6, 1), FieldsAre("c.x", 7, 1)));
}

TEST(Joints, AreWrittenInManyWays) {
  const std::vector<std::vector<std::string>> ways = {
      {"hip_x", "hip_y", "hip_z"}, {"hip.X", "hip.Y", "hip.Z"}, {"hip-X", "hip-Y", "hip-Z"},
      {"hip x", "hip y", "hip z"}, {"hip:X", "hip:Y", "hip:Z"}, {"X.hip", "Y.hip", "Z.hip"}};
  for (const auto& columns : ways)
    EXPECT_THAT(joints(clip_with(columns)), ElementsAre(FieldsAre("hip", 0, 3))) << columns[0];

  const std::vector<std::vector<std::string>> others = {{"hip_x", "hip.y", "hip_z"},
                                                        {"x_hip", "hip_y", "hip_z"},
                                                        {"x", "y", "z"},
                                                        {"_x", "_y", "_z"},
                                                        {"hipx", "hipy", "hipz"}};
  for (const auto& columns : others) EXPECT_EQ(joints(clip_with(columns)).size(), 3) << columns[0];
}

TEST(Joints, CoverEveryColumnOnceInAnyOrderOfAxes) {
  const Clip clip = clip_with({"hip.z", "hip.y", "hip.x", "hip.y", "hip.z"});

  EXPECT_THAT(joints(clip), ElementsAre(FieldsAre("hip.z", 0, 1), FieldsAre("hip.y", 1, 1),
                                        FieldsAre("hip", 2, 3)));
}

TEST(DefaultColumnNames, AreJointsWhenTheCountIsAMultipleOfThree) {
  EXPECT_THAT(default_column_names(6),
              ElementsAre("joint0.x", "joint0.y", "joint0.z", "joint1.x", "joint1.y", "joint1.z"));
  EXPECT_THAT(default_column_names(2), ElementsAre("column0", "column1"));
}

TEST(Cut, KeepsTheRowsAndWhatTheClipSays) {
  Clip clip = clip_with({"a"}, 4);
  clip.samples << 10, 11, 12, 13;
  clip.frame_rate = 120;
  clip.unit = "mm";

  const Clip part = cut(clip, 1, 3);

  EXPECT_THAT(part.samples.reshaped(), ElementsAre(11, 12));
  EXPECT_EQ(part.columns, clip.columns);
  EXPECT_EQ(part.frame_rate, 120);
  EXPECT_EQ(part.unit, "mm");
}

TEST(Cut, RejectsRangesOutsideTheTake) {
  const Clip clip = clip_with({"a"}, 4);

  EXPECT_THROW(cut(clip, -1, 2), ShapeError);
  EXPECT_THROW(cut(clip, 2, 2), ShapeError);
  EXPECT_THROW(cut(clip, 3, 2), ShapeError);
  EXPECT_THROW(cut(clip, 0, 5), ShapeError);
}

}  // namespace
}  // namespace moclean
