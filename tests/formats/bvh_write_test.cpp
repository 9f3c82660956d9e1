#include <any>
#include <cmath>
#include <regex>
#include <string>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"
#include "formats/tiny_files.hpp"
#include "support/data.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::largest_difference;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::string with(std::string_view text, const std::string& what, const std::string& other) {
  return std::regex_replace(std::string(text), std::regex(what), other);
}

std::string as_bvh(const Recording& recording) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "x.bvh";
  write_recording(file, recording);
  return read_file(file);
}

Recording from_bvh(std::string_view text, const FrameRange& frames = {}) {
  const TemporaryFolder folder;
  return read_recording(folder.file("x.bvh", text), {.skeleton = {}, .frames = frames});
}

class BvhAgain : public testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(BvhAgain, IsTheSameByteForByte) {
  const std::string text = with(test::tiny_bvh, GetParam().first, GetParam().second);

  EXPECT_EQ(as_bvh(from_bvh(text)), text);
}

INSTANTIATE_TEST_SUITE_P(
    Each, BvhAgain,
    testing::Values(std::pair{"^$", ""}, std::pair{"\n", "\r\n"}, std::pair{"\n", "\r"},
                    std::pair{"\n", "\n\n"}, std::pair{" ", "\t"}, std::pair{"\n", " \t\n"},
                    std::pair{"^", "\xEF\xBB\xBF"}, std::pair{"Frames: ", "frames:"},
                    std::pair{"0 90", "-0.0 +9.0e1"}, std::pair{"\n$", ""}, std::pair{"$", "\n "},
                    std::pair{"0 0 0\n$", "1e-15 0 370\nend of motion\n1 2\n"}));

TEST(BvhWrite, TurnsPositionsIntoRotationsAndKeepsTheTextOfAllElse) {
  Recording recording = from_bvh(test::tiny_bvh);
  // Frame 1: the foot goes from (6, 2, 3) to (3, 2, 0): the knee, a hinge about x, has to turn, and
  // hip's turn by 90 degrees about z makes the plane that of -x and z.
  recording.samples.row(0) << 1, 2, 3, 1, 0, 3, 1, -3, 3;

  const std::string text = as_bvh(recording);

  EXPECT_EQ(text, with(test::tiny_bvh, "0 0 0 90 0 0 0", "0 0 0 0.0000 0 0 0"));
}

TEST(BvhWrite, KeepsChannelsOfMissingJoints) {
  Recording recording = from_bvh(test::tiny_bvh);
  recording.samples.rightCols(3).setConstant(test::nan);
  recording.samples.row(1).setConstant(test::nan);

  EXPECT_EQ(as_bvh(recording), test::tiny_bvh);
}

TEST(BvhWrite, WritesTheFramesThereAre) {
  const std::string text = as_bvh(from_bvh(test::tiny_bvh, {.first = 1, .last = 2}));

  EXPECT_EQ(text, with(with(test::tiny_bvh, "Frames: 2", "Frames: 1"), "1 2 3 0 0 0 90.*\n", ""));
  EXPECT_EQ(as_bvh(from_bvh(test::tiny_bvh, {.first = 0, .last = 1})),
            with(with(test::tiny_bvh, "Frames: 2", "Frames: 1"), "1 2 3 90 0.*\n", ""));
}

TEST(BvhWrite, KeepsTheTextOfPartsOfARecording) {
  const std::string text = as_bvh(excerpt(from_bvh(test::tiny_bvh), 1, 2));

  EXPECT_EQ(text, as_bvh(from_bvh(test::tiny_bvh, {.first = 1, .last = 2})));
}

TEST(BvhWrite, StatesAnotherRate) {
  Recording recording = from_bvh(test::tiny_bvh);
  recording.frame_rate = 50;

  EXPECT_EQ(as_bvh(recording), with(test::tiny_bvh, ".0083333", "0.02"));
}

TEST(BvhWrite, RefusesRecordingsWithoutRotations) {
  const Recording csv{Matrix{{1, 2, 3}}, {"a.x", "a.y", "a.z"}, 60, "mm"};

  EXPECT_THAT([&] { as_bvh(csv); },
              ThrowsMessage<FileError>(HasSubstr("BVH holds rotations of a skeleton")));
}

class BvhOfTake : public testing::TestWithParam<const char*> {
 protected:
  static std::filesystem::path file() {
    const std::filesystem::path name = GetParam();
    return name.has_parent_path() ? test::shared_data(name) : test::debian_take(name);
  }

  // Of the body, as the largest extent of a frame along an axis.
  static double size_of(const Recording& recording) {
    double size = 0;
    for (Index axis = 0; axis < 3; ++axis) {
      const auto row = recording.samples.row(0)(Eigen::seq(axis, Eigen::last, 3)).eval();
      size = std::max(size, row.maxCoeff() - row.minCoeff());
    }
    return size;
  }
};

TEST_P(BvhOfTake, ComesBackByteForByte) {
  MOCLEAN_REQUIRE_FILE(file());

  // Boxing_Toes.bvh states one frame too few; that is mended.
  const std::string text = with(read_file(file()), "(Frames: +)3069\n", "$013070\n");
  EXPECT_TRUE(as_bvh(read_recording(file())) == text);
}

TEST_P(BvhOfTake, FindsExactPositionsFromOtherRotations) {
  MOCLEAN_REQUIRE_FILE(file());
  Recording recording =
      read_recording(file(), {.skeleton = {}, .frames = {.first = 0, .last = 100}});
  Random random(3);
  Matrix angles = recording.channels;
  for (double& value : angles.reshaped()) value += 0.2 * random.normal();
  recording.channels = angles;  // the root's place, too

  const Recording back = from_bvh(as_bvh(recording));

  EXPECT_LE(largest_difference(back.samples, recording.samples), 1e-4 * size_of(recording));
}

INSTANTIATE_TEST_SUITE_P(Real, BvhOfTake,
                         testing::Values("01_01.bvh", "Boxing_Toes.bvh", "bvh/131_01.bvh",
                                         "bvh/10_03.bvh",
                                         "bvh/AnimatedDrawings_jumping_jacks.bvh"));

}  // namespace
}  // namespace moclean
