#include "moclean/motion/recording.hpp"

#include <any>
#include <string>
#include <utility>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::FieldsAre;

Recording clip_with(std::vector<std::string> columns, Index frames = 1) {
  Recording clip;
  clip.samples = Matrix::Zero(frames, static_cast<Index>(columns.size()));
  clip.columns = std::move(columns);
  return clip;
}

TEST(Joints, GroupThreeNeighboursOfOneName) {
  const Recording clip = clip_with({"hip.x", "hip.y", "hip.z", "knee.x", "knee.y", "knee.z"});

  EXPECT_THAT(joints(clip), ElementsAre(FieldsAre("hip", 0, 3), FieldsAre("knee", 3, 3)));
}

TEST(Joints, LeaveOtherColumnsAlone) {
  const Recording clip =
      clip_with({"force", "hip.x", "hip.y", "hip.z", "a.x", "a.y", "b.z", "c.x"});

  EXPECT_THAT(joints(clip),
              ElementsAre(FieldsAre("force", 0, 1), FieldsAre("hip", 1, 3), FieldsAre("a", 4, 2),
                          FieldsAre("b.z", 6, 1), FieldsAre("c.x", 7, 1)));
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
  const Recording clip = clip_with({"hip.z", "hip.y", "hip.x", "hip.y", "hip.z"});

  EXPECT_THAT(joints(clip), ElementsAre(FieldsAre("hip.z", 0, 1), FieldsAre("hip.y", 1, 1),
                                        FieldsAre("hip", 2, 3)));
}

TEST(DefaultColumnNames, AreJointsWhenTheCountIsAMultipleOfThree) {
  EXPECT_THAT(default_column_names(6),
              ElementsAre("joint0.x", "joint0.y", "joint0.z", "joint1.x", "joint1.y", "joint1.z"));
  EXPECT_THAT(default_column_names(2), ElementsAre("column0", "column1"));
}

TEST(Cut, KeepsTheRowsAndWhatTheRecordingSays) {
  Recording clip = clip_with({"a"}, 4);
  clip.samples << 10, 11, 12, 13;
  clip.frame_rate = 120;
  clip.unit = "mm";

  const Recording part = excerpt(clip, 1, 3);

  EXPECT_THAT(part.samples.reshaped(), ElementsAre(11, 12));
  EXPECT_EQ(part.columns, clip.columns);
  EXPECT_EQ(part.frame_rate, 120);
  EXPECT_EQ(part.unit, "mm");
}

TEST(JointParents, AreTheBonesOfTheSameNames) {
  Skeleton skeleton;
  skeleton.bones = {{.name = "hip"}, {.name = "knee", .parent = 0}, {.name = "head", .parent = 0}};
  Recording clip;
  for (const char* column : {"hip.x", "hip.y", "hip.z", "knee.x", "knee.y", "knee.z"})
    clip.columns.emplace_back(column);
  EXPECT_THAT(joint_parents(skeleton, clip), testing::IsEmpty());  // no head

  for (const char* column : {"head.x", "head.y", "head.z"}) clip.columns.emplace_back(column);
  EXPECT_THAT(joint_parents(skeleton, clip), ElementsAre(-1, 0, 0));

  skeleton.bones[2].name = "neck";
  EXPECT_THAT(joint_parents(skeleton, clip), testing::IsEmpty());
}

TEST(JointPositions, NamesThreeColumnsPerBone) {
  SkeletonMotion motion;
  motion.skeleton.bones = {{.name = "hip", .channels = {Channel::translate_y}}};
  motion.channels = Matrix::Constant(1, 1, 4);
  motion.frame_rate = 30;
  motion.unit = "cm";

  const Recording clip = joint_positions(motion);

  EXPECT_EQ(clip.samples, (Matrix{{0, 4, 0}}));
  EXPECT_THAT(clip.columns, ElementsAre("hip.x", "hip.y", "hip.z"));
  EXPECT_EQ(clip.frame_rate, 30);
  EXPECT_EQ(clip.unit, "cm");
}

// Three frames of a hip that turns about z and a knee below it, with all that a file may say.
Recording walk_of_two() {
  SkeletonMotion motion;
  motion.skeleton.bones = {{.name = "hip", .channels = {Channel::rotate_z}},
                           {.name = "knee", .parent = 0, .offset = {0, -2, 0}}};
  motion.channels = (Matrix(3, 1) << 0, 0.5, 1).finished();
  motion.frame_rate = 120;
  motion.unit = "cm";
  motion.source = std::string("as it was written");
  Recording walk = joint_positions(std::move(motion));
  walk.up = UpAxis::y;
  return walk;
}

TEST(JointPositions, KeepSkeletonChannelsAndSource) {
  const Recording walk = walk_of_two();

  EXPECT_EQ(walk.skeleton->bones.size(), 2U);
  EXPECT_THAT(walk.channels.reshaped(), ElementsAre(0, 0.5, 1));
  EXPECT_EQ(std::any_cast<std::string>(walk.source), "as it was written");
  EXPECT_THAT(joint_parents(walk), ElementsAre(-1, 0));
}

TEST(Cut, KeepsWhatTheRecordingIs) {
  const Recording part = excerpt(walk_of_two(), 1, 3);

  EXPECT_EQ(part.samples, walk_of_two().samples.bottomRows(2));
  EXPECT_THAT(part.channels.reshaped(), ElementsAre(0.5, 1));
  EXPECT_THAT(joint_parents(part), ElementsAre(-1, 0));
  EXPECT_EQ(std::any_cast<std::string>(part.source), "as it was written");
  EXPECT_EQ(part.up, UpAxis::y);
}

TEST(Recording, KeepsConfidencesWithTheSamplesTheyAreOf) {
  Recording walk = walk_of_two();
  walk.confidence = Matrix::Ones(walk.frames(), walk.samples.cols());
  walk.confidence.row(2).setConstant(0.5);
  walk.confidence.col(1).setConstant(0.1);

  EXPECT_EQ(excerpt(walk, 1, 3).confidence, walk.confidence.bottomRows(2));
  EXPECT_EQ(thinned(walk, 2).confidence.row(1), walk.confidence.row(2));
  EXPECT_EQ(columns_of(walk, {1, 2}).confidence, walk.confidence.middleCols(1, 2));
  EXPECT_EQ(like(walk, walk.samples).confidence.size(), 0);
}

TEST(Thinned, TakesEverySoManyFramesOfAll) {
  const Recording thin = thinned(walk_of_two(), 2);

  EXPECT_EQ(thin.samples.row(1), walk_of_two().samples.row(2));
  EXPECT_THAT(thin.channels.reshaped(), ElementsAre(0, 1));
  EXPECT_EQ(thin.frame_rate, 60);
  EXPECT_TRUE(thin.skeleton && thin.source.has_value());
  EXPECT_EQ(thinned(walk_of_two(), 3).frames(), 1);
}

TEST(Like, IsNamedLikeARecordingButIsNotIt) {
  const Recording walk = walk_of_two();

  const Recording other = like(walk, Matrix::Zero(3, 6));

  EXPECT_TRUE((other.samples.array() == 0).all());
  EXPECT_EQ(other.columns, walk.columns);
  EXPECT_EQ(other.frame_rate, 120);
  EXPECT_EQ(other.unit, "cm");
  EXPECT_EQ(other.up, UpAxis::y);
  EXPECT_FALSE(other.skeleton || other.source.has_value());
  EXPECT_EQ(other.channels.size(), 0);
}

TEST(ColumnsOf, ArePickedWithTheirNames) {
  const Recording part = columns_of(walk_of_two(), {4, 0});

  EXPECT_THAT(part.columns, ElementsAre("knee.y", "hip.x"));
  EXPECT_EQ(part.samples.col(0), walk_of_two().samples.col(4));
  EXPECT_EQ(part.frame_rate, 120);
  EXPECT_FALSE(part.skeleton);
}

TEST(JointParents, AreNoneWithoutASkeleton) {
  EXPECT_THAT(joint_parents(clip_with({"hip.x", "hip.y", "hip.z"})), testing::IsEmpty());
}

TEST(Cut, RejectsRangesOutsideTheTake) {
  const Recording clip = clip_with({"a"}, 4);

  EXPECT_THROW(excerpt(clip, -1, 2), ShapeError);
  EXPECT_THROW(excerpt(clip, 2, 2), ShapeError);
  EXPECT_THROW(excerpt(clip, 3, 2), ShapeError);
  EXPECT_THROW(excerpt(clip, 0, 5), ShapeError);
}

}  // namespace
}  // namespace moclean
