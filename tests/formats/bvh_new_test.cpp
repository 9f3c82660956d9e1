// BVH files of skeletons that come from other files.

#include <algorithm>
#include <string>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "moclean/core/random.hpp"
#include "moclean/formats/amc.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"
#include "formats/tiny_files.hpp"
#include "support/data.hpp"
#include "support/matrix.hpp"

namespace moclean {
namespace {

using test::largest_difference;
using testing::HasSubstr;

std::string new_bvh(const Recording& recording) {
  const test::TemporaryFolder folder;
  write_recording(folder.path() / "x.bvh", recording);
  return read_file(folder.path() / "x.bvh");
}

// The positions of the joints of `like` in another recording.
Matrix same_joints(const Recording& recording, const Recording& like) {
  std::vector<Index> columns;
  for (const std::string& name : like.columns)
    columns.push_back(std::ranges::find(recording.columns, name) - recording.columns.begin());
  return recording.samples(Eigen::all, columns);
}

Recording tiny_take() {
  Recording recording =
      joint_positions(parse_amc(test::tiny_amc, "x.amc", parse_asf(test::tiny_asf, "x.asf")));
  recording.frame_rate = 50;
  return recording;
}

TEST(NewBvh, OfAnAcclaimTakeHasItsJointsWhereTheyWere) {
  const Recording take = tiny_take();

  const std::string text = new_bvh(take);
  const Recording back = joint_positions(parse_bvh(text, "x.bvh"));

  EXPECT_LE(largest_difference(same_joints(back, take), take.samples), 1e-6);
  EXPECT_EQ(back.frame_rate, 50);
  // The root turns itself, so the thigh needs a joint to turn at; the shin turns at the thigh's.
  EXPECT_THAT(text, HasSubstr("JOINT thigh_start\n"));
  EXPECT_THAT(text, testing::Not(HasSubstr("shin_start")));
  EXPECT_THAT(text, HasSubstr("CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation "
                              "Xrotation"));
}

TEST(NewBvh, StatesTheRateOfTheCollectionsWhereThereIsNone) {
  Recording take = tiny_take();
  take.frame_rate = 0;

  EXPECT_THAT(new_bvh(take), HasSubstr("Frame Time: 0.0083333333\n"));
}

TEST(NewBvh, SaysChannelsOfABvhSkeletonAsTheyWere) {
  Recording take = joint_positions(parse_bvh(test::tiny_bvh, "x.bvh"));
  take.source.reset();

  const std::string text = new_bvh(take);
  const Recording back = joint_positions(parse_bvh(text, "x.bvh"));

  EXPECT_LE(largest_difference(back.channels, take.channels), 1e-9);
  EXPECT_THAT(text, HasSubstr("CHANNELS 1 Xrotation"));
}

// Constant rotations, far ends, translations, few rotations, several children: whatever a Bone can
// say.
Recording random_take(Random& random) {
  using enum Channel;
  const std::vector<std::vector<Channel>> sets = {
      {rotate_z, rotate_y, rotate_x}, {rotate_x, rotate_z},   {rotate_y}, {},
      {rotate_x, rotate_y, rotate_x}, {translate_z, rotate_y}};
  const auto vector = [&] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  };
  const auto rotation = [&] {
    return Eigen::AngleAxisd(random.normal(), vector().normalized()).toRotationMatrix();
  };
  SkeletonMotion motion;
  for (int b = 0; b < 9; ++b) {
    Bone bone{.name = "b" + std::to_string(b)};
    bone.parent = b == 0 ? -1 : static_cast<int>(random.below(static_cast<std::uint64_t>(b)));
    if (random.below(2)) bone.offset = vector();
    if (random.below(2)) bone.before = rotation();
    if (random.below(2)) bone.after = rotation();
    if (random.below(2)) bone.tail = vector();
    bone.channels = sets[b == 0 ? 0 : random.below(sets.size())];
    motion.skeleton.bones.push_back(bone);
  }
  motion.frame_rate = 60;
  motion.channels.resize(20, motion.skeleton.channels());
  for (double& value : motion.channels.reshaped()) value = random.normal();
  return joint_positions(std::move(motion));
}

TEST(NewBvh, OfAnySkeletonHasItsJointsWhereTheyWere) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Recording take = random_take(random);

    const Recording back = joint_positions(parse_bvh(new_bvh(take), "x.bvh"));

    EXPECT_LE(largest_difference(same_joints(back, take), take.samples), 2e-6) << i;
  }
}

class NewBvhOfTake : public testing::TestWithParam<const char*> {};

TEST_P(NewBvhOfTake, HasItsJointsWhereTheyWere) {
  const auto file = test::shared_data(GetParam());
  MOCLEAN_REQUIRE_FILE(file);
  const Recording take = read_recording(file);

  const Recording back = joint_positions(parse_bvh(new_bvh(take), "x.bvh"));

  const double size = 25;  // ASF units, about that of a man
  EXPECT_LE(largest_difference(same_joints(back, take), take.samples), 1e-6 * size);
}

INSTANTIATE_TEST_SUITE_P(Real, NewBvhOfTake,
                         testing::Values("cmu/02/02_01.amc", "cmu/09/09_06.amc",
                                         "hdm05/HDM_bk_kickLFront1Reps_007_120.amc"));

// Angles go on where a turn is full, as animation programs interpolate them.
TEST(NewBvh, TurnsOnBeyondAHalfTurn) {
  Recording take = tiny_take();
  take.samples.conservativeResize(40, Eigen::NoChange);
  take.channels = Matrix::Zero(40, take.channels.cols());
  for (Index f = 0; f < 40; ++f) take.channels(f, 0) = 0.3 * static_cast<double>(f);
  take.samples = forward_kinematics(*take.skeleton, take.channels);

  const Recording back = joint_positions(parse_bvh(new_bvh(take), "x.bvh"));

  const Matrix steps = back.channels.bottomRows(39) - back.channels.topRows(39);
  EXPECT_LE(steps.cwiseAbs().maxCoeff(), 0.301);
}

}  // namespace
}  // namespace moclean
