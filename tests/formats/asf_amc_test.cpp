#include <any>
#include <memory>
#include <numbers>
#include <regex>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "moclean/formats/amc.hpp"
#include "moclean/formats/asf.hpp"
#include "moclean/motion/framed_source.hpp"

#include "formats/tiny_files.hpp"
#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::largest_difference;
using testing::ElementsAre;

std::string replaced(std::string_view text, const std::string& what, const std::string& with) {
  return std::regex_replace(std::string(text), std::regex(what), with);
}

Recording read(std::string_view amc, std::string_view asf) {
  return joint_positions(parse_amc(amc, "tiny.amc", parse_asf(asf, "tiny.asf")));
}

// The thigh's axis turns x to y, so that `rx` turns about y and `rz` about z.
Matrix tiny_positions() {
  Matrix positions(3, 9);
  positions << 1, 2, 3, 1, 0, 3, 1, -3, 3,  // about y: what points down stays
      1, 2, 3, 3, 2, 3, 6, 2, 3,            // about z: -y becomes x
      1, 2, 3, 1, 2, 1, 1, 2, -2;           // first about x: -y becomes -z; then z does nothing
  return positions;
}

TEST(AsfAmc, GiveThePositionsFoundOnPaper) {
  const Recording clip = read(test::tiny_amc, test::tiny_asf);

  EXPECT_LE(largest_difference(clip.samples, tiny_positions()), test::tolerance::by_hand(6));
  EXPECT_THAT(clip.columns, ElementsAre("root.x", "root.y", "root.z", "thigh.x", "thigh.y",
                                        "thigh.z", "shin.x", "shin.y", "shin.z"));
  EXPECT_EQ(clip.unit, "ASF units");
  EXPECT_EQ(clip.frame_rate, 0);
}

TEST(AsfAmc, KeepWhatIsNeededToWriteTheFileAgain) {
  const std::string header = "#!OML:ASF tiny.asf\n:FULLY-SPECIFIED\n:RADIANS\n";
  const Recording recording = read(header + "7\nthigh 1 0\nroot 1 2 3 0 0 0\n", test::tiny_asf);

  const auto& source = std::any_cast<const FramedSource&>(recording.source);
  const auto& document = *std::any_cast<const std::shared_ptr<const AmcDocument>&>(source.file);
  EXPECT_EQ(document.text.substr(0, document.rows), header);
  EXPECT_EQ(document.radians_per_angle, 1);
  EXPECT_EQ(document.first_number, 7);
  EXPECT_EQ(recording.channels.cols(), 8);
}

class AcclaimSpelling : public testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(AcclaimSpelling, DoesNotChangeThePositions) {
  const auto& [what, with] = GetParam();
  const std::string asf = replaced(test::tiny_asf, what, with);
  const std::string amc = replaced(test::tiny_amc, what, with);

  const Recording clip = read(amc, asf);

  EXPECT_TRUE(asf != test::tiny_asf || amc != test::tiny_amc);
  EXPECT_LE(largest_difference(clip.samples, tiny_positions()), test::tolerance::by_hand(6));
}

INSTANTIATE_TEST_SUITE_P(
    Each, AcclaimSpelling,
    testing::Values(std::pair{"\n", "\r\n"}, std::pair{"\n", "\r"}, std::pair{" ", "\t"},
                    std::pair{"\n", "  # comment\n"}, std::pair{"^", "\xEF\xBB\xBF"},
                    std::pair{":DEGREES\n", ""}, std::pair{":FULLY-SPECIFIED\n", ""},
                    std::pair{":DEGREES", ":degrees"}, std::pair{"angle deg", "angle Degrees"},
                    std::pair{"length 2", "length +2.0e0"},
                    std::pair{"    id 1\n", "    id 1\n    bodymass 2.5\n"}));

TEST(AsfAmc, FirstNumberOfTheFramesIsFree) {
  const std::string amc = replaced(
      replaced(replaced(test::tiny_amc, "\n3\n", "\n12\n"), "\n2\n", "\n11\n"), "\n1\n", "\n10\n");

  EXPECT_EQ(read(amc, test::tiny_asf).frames(), 3);
}

TEST(AsfAmc, TakeRadiansWhereTheFilesSaySo) {
  const std::string quarter = fmt::format("{}", std::numbers::pi / 2);
  const std::string asf =
      replaced(replaced(test::tiny_asf, "angle deg", "angle rad"), "0 0 90", "0 0 " + quarter);
  const std::string amc = replaced(test::tiny_amc, "90", quarter);

  const Recording stated = read(replaced(amc, ":DEGREES", ":RADIANS"), asf);
  const Recording inherited = read(replaced(amc, ":DEGREES\n", ""), asf);
  const Recording mixed = read(test::tiny_amc, asf);

  for (const Recording& clip : {stated, inherited, mixed})
    EXPECT_LE(largest_difference(clip.samples, tiny_positions()), test::tolerance::by_hand(6));
}

TEST(AsfAmc, AddPositionAndOrientationOfTheRoot) {
  const std::string asf = replaced(replaced(test::tiny_asf, "position 0 0 0", "position 10 20 30"),
                                   "orientation 0 0 0", "orientation 0 0 90");

  const Recording clip = read("1\nroot 1 2 3 0 0 0\nthigh 0 0\n", asf);

  // The preset turns the whole recording: (1, 2, 3) becomes (-2, 1, 3), down becomes x.
  EXPECT_LE(largest_difference(clip.samples, Matrix{{8, 21, 33, 10, 21, 33, 13, 21, 33}}),
            test::tolerance::by_hand(33));
}

TEST(AsfAmc, MoveABoneByItsTranslations) {
  const std::string asf = replaced(test::tiny_asf, "dof rx rz", "dof tx");

  const Recording clip = read("1\nroot 0 0 0 0 0 0\nthigh 5\n", asf);

  // Along x of the bone's frame, which is the world's y.
  EXPECT_LE(largest_difference(clip.samples, Matrix{{0, 0, 0, 0, 3, 0, 0, 0, 0}}),
            test::tolerance::by_hand(5));
}

struct Case {
  std::string order;
  Eigen::Vector3d joint;
};

class DofOrder : public testing::TestWithParam<Case> {};

// Quarter turns of (1, 2, 3), the first degree of freedom first; see RotationOrder in motion_test.
TEST_P(DofOrder, TurnsAboutTheFirstOneFirst) {
  const std::string asf =
      replaced(replaced(replaced(test::tiny_asf, "dof rx rz", "dof " + GetParam().order),
                        "direction 0 -1 0\n    length 2", "direction 1 2 3\n    length 1"),
               "axis 0 0 90", "axis 0 0 0");

  const Recording clip = read("1\nroot 0 0 0 0 0 0\nthigh 90 90 90\n", asf);

  EXPECT_LE(largest_difference(clip.samples.middleCols(3, 3), GetParam().joint.transpose()),
            test::tolerance::by_hand(3));
}

INSTANTIATE_TEST_SUITE_P(AllSix, DofOrder,
                         testing::Values(Case{"rz ry rx", {3, -2, 1}}, Case{"ry rz rx", {-2, 1, 3}},
                                         Case{"rz rx ry", {1, -3, 2}}, Case{"rx rz ry", {2, 1, -3}},
                                         Case{"ry rx rz", {-1, 3, 2}},
                                         Case{"rx ry rz", {3, 2, -1}}));

class AxisOrder : public testing::TestWithParam<Case> {};

// The axis turns x into one of the world's axes: XYZ (x first) to -z, ZYX to z, YXZ to -x. A
// quarter turn of (1, 2, 3) about that one is easy.
TEST_P(AxisOrder, TurnsAboutTheFirstLetterFirst) {
  const std::string asf =
      replaced(replaced(replaced(test::tiny_asf, "dof rx rz", "dof rx"),
                        "direction 0 -1 0\n    length 2", "direction 1 2 3\n    length 1"),
               "axis 0 0 90 XYZ", "axis 90 90 90 " + GetParam().order);

  const Recording clip = read("1\nroot 0 0 0 0 0 0\nthigh 90\n", asf);

  EXPECT_LE(largest_difference(clip.samples.middleCols(3, 3), GetParam().joint.transpose()),
            test::tolerance::by_hand(3));
}

INSTANTIATE_TEST_SUITE_P(Three, AxisOrder,
                         testing::Values(Case{"XYZ", {2, -1, 3}}, Case{"zyx", {-2, 1, 3}},
                                         Case{"YXZ", {1, 3, -2}}));

TEST(AsfAmc, ReadRootNumbersInTheOrderOfTheSkeleton) {
  const std::string asf = replaced(test::tiny_asf, "TX TY TZ RX RY RZ", "RZ TY TX TZ");

  const Recording clip = read("1\nroot 90 2 1 3\nthigh 0 0\n", asf);

  EXPECT_LE(largest_difference(clip.samples, Matrix{{1, 2, 3, 3, 2, 3, 6, 2, 3}}),
            test::tolerance::by_hand(6));
}

TEST(AsfAmc, KeepBoneLengthsInEveryFrame) {
  const AcclaimSkeleton skeleton = parse_asf(test::tiny_asf, "tiny.asf");
  std::string amc;
  for (int f = 1; f <= 50; ++f)
    amc += fmt::format("{}\nroot {} 2 3 {} {} {}\nthigh {} {}\n", f, f, 7 * f, 11 * f, 13 * f,
                       17 * f, 19 * f);

  const Recording clip = joint_positions(parse_amc(amc, "tiny.amc", skeleton));

  for (Index f = 0; f < clip.frames(); ++f) {
    const auto joint = [&](Index j) { return clip.samples.row(f).segment<3>(3 * j); };
    EXPECT_NEAR((joint(1) - joint(0)).norm(), 2, test::tolerance::by_hand(50));
    EXPECT_NEAR((joint(2) - joint(1)).norm(), 3, test::tolerance::by_hand(50));
  }
}

}  // namespace
}  // namespace moclean
