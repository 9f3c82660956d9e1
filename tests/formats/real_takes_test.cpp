#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "moclean/formats/asf.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/find_skeleton.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"
#include "support/data.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

struct Take {
  std::string file;
  Index frames;
  Index joints;
  double rate;
};

void PrintTo(const Take& take, std::ostream* out) { *out << take.file; }

class BvhTake : public testing::TestWithParam<Take> {};

TEST_P(BvhTake, HasItsFramesJointsAndRate) {
  const Take& take = GetParam();
  const bool shared = take.file.starts_with("bvh/");
  const auto file = shared ? test::shared_data(take.file) : test::debian_take(take.file);
  MOCLEAN_REQUIRE_FILE(file);

  const Recording clip = read_recording(file);

  EXPECT_EQ(clip.frames(), take.frames);
  EXPECT_EQ(clip.samples.cols(), 3 * take.joints);
  EXPECT_EQ(static_cast<Index>(joints(clip).size()), take.joints);
  EXPECT_EQ(clip.frame_rate, take.rate);
  EXPECT_TRUE(clip.samples.allFinite());
}

INSTANTIATE_TEST_SUITE_P(
    Real, BvhTake,
    testing::Values(Take{"01_01.bvh", 2752, 31, 120}, Take{"01_03.bvh", 4511, 31, 120},
                    Take{"Boxing_Toes.bvh", 3070, 21, 100}, Take{"bvh/131_01.bvh", 994, 31, 120},
                    Take{"bvh/10_03.bvh", 363, 43, 120},
                    Take{"bvh/AnimatedDrawings_jumping_jacks.bvh", 125, 31, 30}));

class AmcTake : public testing::TestWithParam<Take> {};

TEST_P(AmcTake, KeepsTheBoneLengthsOfItsSkeleton) {
  const auto file = test::shared_data(GetParam().file);
  MOCLEAN_REQUIRE_FILE(file);
  const auto asf = find_skeleton(file);
  const Skeleton skeleton = parse_asf(read_file(asf), asf).skeleton;

  const Recording clip = read_recording(file);

  ASSERT_EQ(clip.frames(), GetParam().frames);
  ASSERT_EQ(clip.samples.cols(), 3 * GetParam().joints);
  for (std::size_t b = 1; b < skeleton.bones.size(); ++b) {
    const Bone& bone = skeleton.bones[b];
    const auto joint = clip.samples.middleCols<3>(3 * static_cast<Index>(b));
    const auto parent = clip.samples.middleCols<3>(3 * bone.parent);
    const Eigen::ArrayXd lengths = (joint - parent).rowwise().norm();
    EXPECT_LE((lengths - bone.tail.norm()).abs().maxCoeff(),
              test::tolerance::by_hand(clip.samples.cwiseAbs().maxCoeff()))
        << bone.name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Real, AmcTake,
    testing::Values(Take{"cmu/14/14_06.amc", 5357, 31, 0}, Take{"cmu/02/02_01.amc", 343, 31, 0},
                    Take{"cmu/17/17_10.amc", 2783, 31, 0}, Take{"cmu/49/49_18.amc", 1102, 31, 0},
                    Take{"hdm05/HDM_bk_depositFloorR_010_120.amc", 461, 31, 0}));

// Lengths as 14.asf prints them: the reader has to take them from there, not only keep them.
TEST(AmcTake, HasTheLengthsPrintedInTheSkeletonFile) {
  const auto file = test::shared_data("cmu/14/14_06.amc");
  MOCLEAN_REQUIRE_FILE(file);

  const Recording clip = read_recording(file);

  const auto length = [&](const std::string& a, const std::string& b) {
    Eigen::Vector3d difference = Eigen::Vector3d::Zero();
    for (const Joint& joint : joints(clip)) {
      const Eigen::Vector3d position = clip.samples.row(100).segment<3>(joint.first_column);
      if (joint.name == a) difference += position;
      if (joint.name == b) difference -= position;
    }
    return difference.norm();
  };
  EXPECT_NEAR(length("root", "lhipjoint"), 2.52133, 2.52133 * test::tolerance::printed_digits());
  EXPECT_NEAR(length("lhipjoint", "lfemur"), 7.51824, 7.51824 * test::tolerance::printed_digits());
  EXPECT_NEAR(length("lfemur", "ltibia"), 7.3685, 7.3685 * test::tolerance::printed_digits());
  EXPECT_NEAR(length("root", "lowerback"), 2.08277, 2.08277 * test::tolerance::printed_digits());
}

struct C3dTake {
  std::string file;
  Index frames;
  Index points;
  double rate;
  Index missing;  // points, counted in every frame, by another reading of the bytes (NumPy)
};

void PrintTo(const C3dTake& take, std::ostream* out) { *out << take.file; }

class C3dTakes : public testing::TestWithParam<C3dTake> {};

TEST_P(C3dTakes, HasItsPointsAndGapsAndIsWrittenWithoutAByteChanged) {
  const C3dTake& expected = GetParam();
  const auto file = test::shared_data("c3d/" + expected.file);
  MOCLEAN_REQUIRE_FILE(file);
  const test::TemporaryFolder folder;

  const Recording take = read_recording(file);
  write_recording(folder.path() / "out.c3d", take);

  EXPECT_EQ(take.frames(), expected.frames);
  EXPECT_EQ(take.samples.cols(), 3 * expected.points);
  EXPECT_EQ(take.frame_rate, expected.rate);
  EXPECT_EQ(take.samples.array().isNaN().count(), 3 * expected.missing);
  EXPECT_TRUE(read_file(folder.path() / "out.c3d") == read_file(file));
}

INSTANTIATE_TEST_SUITE_P(Real, C3dTakes,
                         testing::Values(C3dTake{"02_01.c3d", 343, 41, 120, 0},
                                         C3dTake{"03_rolling.c3d", 2305, 68, 175, 35965},
                                         C3dTake{"mocap36.c3d", 1380, 36, 100, 8244},
                                         C3dTake{"phasespace_sample.c3d", 701, 40, 30, 1281},
                                         C3dTake{"walkingOptiTrack.c3d", 3361, 12, 160, 2996}));

// markers/NAME.npy has the points of c3d/NAME.c3d but those seen under 30 % of the time.
TEST(RealC3d, HasTheSamplesThatAnotherReaderFound) {
  for (const std::string name : {"02_01", "03_rolling", "mocap36"}) {
    const auto file = test::shared_data("c3d/" + name + ".c3d");
    MOCLEAN_REQUIRE_FILE(file);
    const Recording take = read_recording(file);
    const Recording markers = read_recording(test::shared_data("markers/" + name + ".npy"));
    std::vector<Index> seen;
    for (Index c = 0; c < take.samples.cols(); ++c)
      if (10 * take.samples.col(c).array().isNaN().count() <= 7 * take.frames()) seen.push_back(c);

    const Matrix samples = columns_of(take, seen).samples;

    ASSERT_EQ(samples.cols(), markers.samples.cols()) << name;
    EXPECT_TRUE(((samples.array() == markers.samples.array()) ||
                 (samples.array().isNaN() && markers.samples.array().isNaN()))
                    .all())
        << name;
  }
}

}  // namespace
}  // namespace moclean
