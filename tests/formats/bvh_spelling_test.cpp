// BVH files as people have them: what other programs and hands do to the motion section.

#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"
#include "support/matrix.hpp"

namespace moclean {
namespace {

using test::largest_difference;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

// A joint that moves along x and y, and one 10 above it.
const std::string hierarchy = R"(HIERARCHY
ROOT Hips
{
  OFFSET 0.0 0.0 0.0
  CHANNELS 3 Xposition Yposition Zrotation
  JOINT Spine
  {
    OFFSET 0.0 10.0 0.0
    CHANNELS 1 Zrotation
    End Site
    {
      OFFSET 0.0 5.0 0.0
    }
  }
}
)";
const std::string header = "MOTION\nFrames: 2\nFrame Time: 0.01\n";
const std::string rows = "1.5 2 0 0\n3 4 90 -1.25\n";

const Matrix positions{{1.5, 2, 0, 1.5, 12, 0}, {3, 4, 0, -7, 4, 0}};

Recording read_text(const std::string& text, double rate = 0) {
  const test::TemporaryFolder folder;
  return read_recording(folder.file("x.bvh", text), {.skeleton = {}, .rate = rate});
}

std::string written(const Recording& recording) {
  const test::TemporaryFolder folder;
  write_recording(folder.path() / "y.bvh", recording);
  return read_file(folder.path() / "y.bvh");
}

std::string message_of(const std::string& text, double rate = 0) {
  try {
    read_text(text, rate);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

struct Spelling {
  std::string name;
  std::string motion;  // all from MOTION on
};

void PrintTo(const Spelling& spelling, std::ostream* out) { *out << spelling.name; }

class BvhMotionSpelling : public testing::TestWithParam<Spelling> {};

TEST_P(BvhMotionSpelling, IsReadAndWrittenAsItIs) {
  const std::string text = hierarchy + GetParam().motion;

  const Recording recording = read_text(text);

  EXPECT_LE(largest_difference(recording.samples, positions), 1e-12);
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_THAT(recording.notes.warnings, IsEmpty());
  EXPECT_EQ(written(recording), text);
}

INSTANTIATE_TEST_SUITE_P(
    Each, BvhMotionSpelling,
    testing::Values(
        Spelling{"plain", header + rows},
        Spelling{"blank before colon", "MOTION\nFrames : 2\nFrame Time : 0.01\n" + rows},
        Spelling{"no colon", "MOTION\nFrames 2\nFrame Time 0.01\n" + rows},
        Spelling{"one word", "MOTION\nFrames: 2\nFrameTime: 0.01\n" + rows},
        Spelling{"one word, no blank", "MOTION\nFrames:2\nFRAMETIME:0.01\n" + rows},
        Spelling{"float count", "MOTION\nFrames: 2.0\nFrame Time: 0.01\n" + rows},
        Spelling{"time first", "MOTION\nFrame Time: 0.01\nFrames: 2\n" + rows},
        Spelling{"blanks behind the count", "MOTION\nFrames: 2    \nFrame Time: 0.01  \n" + rows},
        Spelling{"no last line end", header + rows.substr(0, rows.size() - 1)},
        Spelling{"blank lines", header + "1.5 2 0 0\n\n3 4 90 -1.25\n\n\n"},
        Spelling{"wrapped", header + "1.5 2\n0 0\n3 4\n90 -1.25\n"},
        Spelling{"wrapped but for the first", header + "1.5 2 0 0\n3 4\n90 -1.25\n"},
        Spelling{"wrapped unevenly", header + "1.5\n2 0\n0\n3\n4 90\n-1.25\n"},
        Spelling{"decimal commas",
                 "MOTION\nFrames: 2\nFrame Time: 0,01\n1,5 2,0 0 0\n3 4 90 "
                 "-1,25\n"}),
    [](const auto& test) {
      std::string name = test.param.name;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
      return name;
    });

TEST(BvhLines, BeyondTheStatedFramesAreFramesAndCounted) {
  const Recording recording = read_text(hierarchy + "MOTION\nFrames: 1\nFrame Time: 0.01\n" + rows);

  EXPECT_LE(largest_difference(recording.samples, positions), 1e-12);
  EXPECT_THAT(recording.notes.warnings, ElementsAre("states 1 frames but holds 2; all are used"));
  EXPECT_EQ(written(recording), hierarchy + header + rows);
}

// Found by fuzzing: the part of such a file could not be read again.
TEST(BvhLines, MayWrapAfterTheFirstWithWordsBehindThem) {
  const Recording recording =
      read_text(hierarchy + header + "1.5 2 0 0\n3 4\n90 -1.25\nYposition\n");

  EXPECT_LE(largest_difference(recording.samples, positions), 1e-12);
  EXPECT_EQ(recording.frames(), 2);
}

TEST(BvhLines, FewerThanStatedAreReadWithAWordOfBothCounts) {
  const Recording recording =
      read_text(hierarchy + "MOTION\nFrames: 999999999999\nFrame Time: 0.01\n" + rows);

  EXPECT_EQ(recording.frames(), 2);
  EXPECT_THAT(recording.notes.warnings,
              ElementsAre("states 999999999999 frames but holds 2; these are used"));
}

TEST(BvhLines, OfWhichTheLastBreaksOffAreReadWithoutIt) {
  for (const std::string rest : {"5 6\n", "5 6", "5 6 7 -", "5 6 1e", "5"}) {
    const Recording recording =
        read_text(hierarchy + "MOTION\nFrames: 3\nFrame Time: 0.01\n" + rows + rest);

    EXPECT_LE(largest_difference(recording.samples, positions), 1e-12);
    EXPECT_THAT(
        recording.notes.warnings,
        ElementsAre(testing::MatchesRegex(
                        "line 21 breaks off: [1-3] of 4 numbers of a frame; it is left out"),
                    "states 3 frames but holds 2; these are used"));
    EXPECT_EQ(written(recording), hierarchy + header + rows) << rest;
  }
}

TEST(BvhLines, ThatBreakOffInTheMiddleOfTheFileAreAnError) {
  EXPECT_THAT(message_of(hierarchy + header + "1 2 3 4\n1 2 3\n1 2 3 4\n"),
              HasSubstr("x.bvh:20: expected 4 numbers per frame, found 3"));
  EXPECT_THAT(message_of(hierarchy + header + "1 2 3\n1 2 3 4\n"),
              HasSubstr("x.bvh:19: expected 4 numbers per frame, found 3"));
}

// Two lines of half the numbers for each of the stated frames: a hierarchy of another file.
TEST(BvhLines, ThatAreAsManyAsTheFramesAreNotPartsOfFrames) {
  EXPECT_THAT(message_of(hierarchy + "MOTION\nFrames: 4\nFrame Time: 1\n1 2\n3 4\n5 6\n7 8\n"),
              HasSubstr("expected 4 numbers per frame, found 2 in line 19"));
}

TEST(BvhLines, BehindTheFramesThatAreNoFramesAreKept) {
  const std::string text = hierarchy + header + rows + "exported by hand\n1 2 3\n";

  const Recording recording = read_text(text);

  EXPECT_EQ(recording.frames(), 2);
  EXPECT_THAT(recording.notes.warnings,
              ElementsAre("line 21 and what follows it is no frame; kept as it is"));
  EXPECT_EQ(written(recording), text);
}

TEST(BvhLines, WithoutAFrameAreAnError) {
  EXPECT_THAT(message_of(hierarchy),
              HasSubstr("expected ROOT or MOTION, found the end of the file"));
  EXPECT_THAT(message_of(hierarchy + "MOTION\nFrames: 0\nFrame Time: 1\n\n"),
              HasSubstr("expected at least one frame, found 'Frames: 0'"));
  EXPECT_THAT(message_of(hierarchy + header), HasSubstr("expected 2 frames, found none"));
}

class BvhFrameTime : public testing::TestWithParam<std::string> {};

TEST_P(BvhFrameTime, ThatIsNoneNeedsTheRateOption) {
  const std::string text = hierarchy + "MOTION\nFrames: 2\n" + GetParam() + rows;

  const Recording recording = read_text(text, 50);

  EXPECT_THAT(message_of(text), HasSubstr("--rate"));
  EXPECT_EQ(recording.frame_rate, 50);
  EXPECT_LE(largest_difference(recording.samples, positions), 1e-12);
  EXPECT_EQ(written(recording), hierarchy + "MOTION\nFrames: 2\nFrame Time: 0.02\n" + rows);
}

INSTANTIATE_TEST_SUITE_P(Each, BvhFrameTime,
                         testing::Values("", "Frame Time: 0\n", "Frame Time: nan\n",
                                         "Frame Time: -1.#IND\n", "Frame Time: -0.01\n",
                                         "Frame Time: 1e-310\n"));

TEST(BvhRate, ThatWasGivenWinsWithAWord) {
  const Recording recording = read_text(hierarchy + header + rows, 30);

  EXPECT_EQ(recording.frame_rate, 30);
  EXPECT_THAT(recording.notes.warnings,
              ElementsAre("Frame Time states 100 Hz; the rate that was given, 30 Hz, is used"));
  EXPECT_THAT(read_text(hierarchy + header + rows, 100).notes.warnings, IsEmpty());
}

TEST(BvhChannel, ThatIsMissingHidesTheJointsBelowAndKeepsItsText) {
  const double gap = std::numeric_limits<double>::quiet_NaN();
  for (const std::string none : {"nan", "NaN", "-nan", "-1.#IND", "1.#QNAN00"}) {
    const std::string text = hierarchy + header + "1.5 2 " + none + " 0\n3 " + none + " 90 -1.25\n";

    const Recording recording = read_text(text);

    // Without its turn the root still has its place; without a coordinate it has none.
    const Matrix expected{{1.5, 2, 0, gap, gap, gap}, {gap, gap, gap, gap, gap, gap}};
    EXPECT_TRUE(test::same_bits(recording.samples.array().isNaN().cast<double>().matrix().eval(),
                                expected.array().isNaN().cast<double>().matrix().eval()));
    EXPECT_EQ(written(recording), text);
  }
}

TEST(BvhChannel, ThatWasMissingIsANumberWhereItsJointsWereFilled) {
  Recording recording = read_text(hierarchy + header + "1.5 2 nan 0\n3 nan 90 -1.25\n");
  recording.samples.row(0) = positions.row(0);

  EXPECT_THAT(written(recording), HasSubstr("0.01\n1.5 2 0.0000 0\n3 nan 90 -1.25\n"));
}

TEST(BvhChannel, ThatIsInfiniteIsAnError) {
  for (const std::string huge : {"inf", "-INF", "1e999", "1.#INF"})
    EXPECT_THAT(message_of(hierarchy + header + "1 2 3 4\n1 " + huge + " 3 4\n"),
                HasSubstr("x.bvh:20: expected a number, found '" + huge + "'"));
}

TEST(BvhJoints, OfOneNameHaveColumnsOfTheirOwnAndKeepTheirNameInTheFile) {
  std::string text = hierarchy + header + rows;
  text.replace(text.find("Spine"), 5, "Hips");

  const Recording recording = read_text(text);

  EXPECT_EQ(recording.columns[0], "Hips.x");
  EXPECT_EQ(recording.columns[3], "Hips_2.x");
  EXPECT_EQ(written(recording), text);
}

TEST(BvhJoints, OfOneNameDoNotTakeThatOfAThird) {
  const std::string text =
      "HIERARCHY\nROOT a { OFFSET 0 0 0 CHANNELS 1 Xposition\n"
      "JOINT a_2 { OFFSET 0 1 0 }\nJOINT a { OFFSET 0 1 0 }\n"
      "JOINT a { OFFSET 0 1 0 } }\nMOTION\nFrames: 1\nFrame Time: 1\n7\n";

  const Recording recording = read_text(text);

  EXPECT_THAT(recording.columns, testing::Contains("a_2.x").Times(1));
  EXPECT_EQ(recording.columns[6], "a_3.x");
  EXPECT_EQ(recording.columns[9], "a_4.x");
}

TEST(BvhJoints, KeepBlanksAndColonsInTheirNames) {
  std::string text = hierarchy + header + rows;
  text.replace(text.find("Hips"), 4, "mixamorig:Left Hand");

  EXPECT_EQ(read_text(text).columns[1], "mixamorig:Left Hand.y");
}

TEST(BvhJoints, MayHaveNoChannelsAndNamedEnds) {
  const std::string text = R"(# by hand
// and so on
HIERARCHY
ROOT a { OFFSET 0 0 0 CHANNELS 1 Zrotation
  # note
  JOINT b { OFFSET 1 0 0 CHANNELS 0
    End Site Tip of b { OFFSET 1 0 0 } } }
MOTION
Frames: 1
Frame Time: 0.01
90
)";

  const Recording recording = read_text(text);

  EXPECT_LE(largest_difference(recording.samples, Matrix{{0, 0, 0, 0, 1, 0}}), 1e-12);
  EXPECT_EQ(written(recording), text);
}

TEST(BvhJoints, WithoutChannelsMayNotTakeMemoryOutOfProportion) {
  std::string text = "HIERARCHY\nROOT r { OFFSET 0 0 0 CHANNELS 1 Xrotation\n";
  for (int j = 0; j < 2000; ++j) text += "JOINT j { OFFSET 0 0 0 }\n";
  text += "}\nMOTION\nFrames: 20000\nFrame Time: 1\n";
  for (int f = 0; f < 20000; ++f) text += "1\n";

  EXPECT_THAT(message_of(text), HasSubstr("out of proportion to the file"));
}

TEST(BvhDecimals, BehindACommaAreWrittenBehindOne) {
  Recording recording = read_text(
      hierarchy + "MOTION\nFrames: 2\nFrame Time: 0,01\n1,5 2,0 0,00 0\n3 4 90 -1,25\n", 50);
  recording.samples(1, 0) += 0.125;
  recording.samples(1, 3) += 0.125;

  EXPECT_EQ(written(recording), hierarchy +
                                    "MOTION\nFrames: 2\nFrame Time: 0,02\n"
                                    "1,5 2,0 0,00 0\n3,1250 4 90 -1,25\n");
}

}  // namespace
}  // namespace moclean
