#include "moclean/formats/bvh.hpp"

#include <any>
#include <memory>
#include <numbers>
#include <regex>
#include <string>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/frame_rate.hpp"
#include "moclean/motion/framed_source.hpp"

#include "formats/tiny_files.hpp"
#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::largest_difference;
using testing::ElementsAre;

Recording read(std::string_view text) { return joint_positions(parse_bvh(text, "tiny.bvh")); }

std::string replaced(std::string_view text, const std::string& what, const std::string& with) {
  return std::regex_replace(std::string(text), std::regex(what), with);
}

Matrix tiny_positions() {
  Matrix positions(2, 9);
  positions << 1, 2, 3, 1, 0, 3, 1, 0, 0,  // knee bent by 90 degrees about x: -y becomes -z
      1, 2, 3, 3, 2, 3, 6, 2, 3;           // hip turned by 90 degrees about z: -y becomes x
  return positions;
}

TEST(Bvh, GivesThePositionsFoundOnPaper) {
  const Recording clip = read(test::tiny_bvh);

  EXPECT_LE(largest_difference(clip.samples, tiny_positions()), test::tolerance::by_hand(6));
  EXPECT_THAT(clip.columns, ElementsAre("hip.x", "hip.y", "hip.z", "knee.x", "knee.y", "knee.z",
                                        "foot.x", "foot.y", "foot.z"));
  EXPECT_EQ(clip.frame_rate, 120);
  EXPECT_EQ(clip.unit, "");
}

TEST(Bvh, KeepsWhatIsNeededToWriteTheFileAgain) {
  const Recording recording = read(test::tiny_bvh);

  const auto& source = std::any_cast<const FramedSource&>(recording.source);
  const auto& document = *std::any_cast<const std::shared_ptr<const BvhDocument>&>(source.file);
  EXPECT_EQ(document.text, test::tiny_bvh);
  EXPECT_EQ(document.text.substr(document.rows, 5), "1 2 3");
  EXPECT_EQ(document.frame_time, .0083333);
  EXPECT_EQ(recording.skeleton->bones[2].name, "foot");
  EXPECT_EQ(recording.channels.cols(), 10);
  EXPECT_EQ(recording.channels(0, 6), std::numbers::pi / 2);
}

class BvhSpelling : public testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(BvhSpelling, DoesNotChangeThePositions) {
  const auto& [what, with] = GetParam();
  const std::string text = replaced(test::tiny_bvh, what, with);
  ASSERT_NE(text, test::tiny_bvh);

  const Recording clip = read(text);

  EXPECT_LE(largest_difference(clip.samples, tiny_positions()), test::tolerance::by_hand(6));
  EXPECT_EQ(clip.frame_rate, 120);
}

INSTANTIATE_TEST_SUITE_P(
    Each, BvhSpelling,
    testing::Values(std::pair{"\n", "\r\n"}, std::pair{"\n", "\r"}, std::pair{"\n", "\n\n"},
                    std::pair{" ", "\t"}, std::pair{"\n", " \t\n"}, std::pair{"^", "\xEF\xBB\xBF"},
                    std::pair{"\n *\\{", " {"}, std::pair{"Frames: ", "Frames:"},
                    std::pair{"rotation", "ROTATION"}, std::pair{"JOINT", "joint"},
                    std::pair{"-3 0", "-3.0E+00 +0"}, std::pair{"90", "+9e1"}, std::pair{"\n$", ""},
                    std::pair{"End Site", "End site"}));

TEST(Bvh, AcceptsNamesWithBlanks) {
  const Recording clip = read(replaced(test::tiny_bvh, "JOINT knee", "JOINT left knee 2 "));

  EXPECT_EQ(clip.columns[3], "left knee 2.x");
}

TEST(Bvh, ReplacesTheOffsetByPositionChannels) {
  const std::string hierarchy = R"(HIERARCHY
ROOT a { OFFSET 5 6 7 CHANNELS 2 Zrotation Xposition
  JOINT b { OFFSET 1 2 3 CHANNELS 2 Yposition Zrotation } }
MOTION
Frames: 1
Frame Time: 0.1
90 10 20 0
)";

  const Recording clip = read(hierarchy);

  // a at (10, 6, 7); b at a + Rz(90) (1, 20, 3) = a + (-20, 1, 3).
  EXPECT_LE(largest_difference(clip.samples, Matrix{{10, 6, 7, -10, 7, 10}}),
            test::tolerance::by_hand(20));
}

TEST(Bvh, ReadsSeveralRoots) {
  const std::string text = R"(HIERARCHY
ROOT a { OFFSET 1 0 0 CHANNELS 1 Zrotation }
ROOT b { OFFSET 2 0 0 }
MOTION
Frames: 1
Frame Time: 0.1
90
)";

  EXPECT_EQ(read(text).samples, (Matrix{{1, 0, 0, 2, 0, 0}}));
}

TEST(Bvh, ReadsHierarchiesOfAnyDepth) {
  constexpr int depth = 100000;
  std::string text = "HIERARCHY\nROOT r { OFFSET 0 0 0 CHANNELS 1 Xposition\n";
  for (int i = 0; i < depth; ++i) text += "JOINT j { OFFSET 0 1 0\n";
  text += std::string(depth + 1, '}') + "\nMOTION\nFrames: 1\nFrame Time: 1\n7\n";

  const Recording clip = read(text);

  EXPECT_EQ(clip.samples(0, 3 * depth + 1), depth);
}

TEST(FrameRate, IsWholeWhenThePeriodIsRounded) {
  EXPECT_EQ(rate_from_period(.0083333), 120);
  EXPECT_EQ(rate_from_period(.008333), 120);
  EXPECT_EQ(rate_from_period(.03333), 30);
  EXPECT_EQ(rate_from_period(0.01), 100);
  EXPECT_EQ(rate_from_period(2), 0.5);
}

TEST(FrameRate, KeepsNtscRates) {
  EXPECT_EQ(rate_from_period(0.0417083), 1 / 0.0417083);  // 23.976
  EXPECT_EQ(rate_from_period(0.0333667), 1 / 0.0333667);  // 29.97
}

}  // namespace
}  // namespace moclean
