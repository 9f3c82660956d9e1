#include "moclean/formats/trc.hpp"

#include <regex>
#include <string>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"
#include "formats/tiny_files.hpp"
#include "support/data.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::nan;
using test::same_bits;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

Matrix tiny_samples() {
  return Matrix{
      {1.5, -2.25, 3, 4, 5, 6}, {nan, nan, nan, 4.1, 5.1, 6.1}, {1.7, -2.45, 3.2, nan, nan, nan}};
}

std::string replaced(std::string_view text, const std::string& what, const std::string& with) {
  return std::regex_replace(std::string(text), std::regex(what), with);
}

// What is written of a recording.
std::string written(const Recording& recording) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "x.trc";
  write_recording(file, recording);
  return read_file(file);
}

TEST(Trc, ReadsMarkersTheirUnitAndTheRate) {
  const Recording recording = parse_trc(test::tiny_trc, "tiny.trc");

  EXPECT_TRUE(same_bits(recording.samples, tiny_samples()));
  EXPECT_THAT(recording.columns,
              ElementsAre("R Heel.x", "R Heel.y", "R Heel.z", "b.x", "b.y", "b.z"));
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_EQ(recording.unit, "mm");
}

class TrcSpelling : public testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(TrcSpelling, ChangesNoSampleAndComesBackByteForByte) {
  const auto& [what, with] = GetParam();
  const std::string text = replaced(test::tiny_trc, what, with);
  ASSERT_NE(text, test::tiny_trc);

  const Recording recording = parse_trc(text, "tiny.trc");

  EXPECT_TRUE(same_bits(recording.samples, tiny_samples()));
  EXPECT_EQ(recording.columns.size(), 6U);
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_EQ(written(recording), text);
}

INSTANTIATE_TEST_SUITE_P(Each, TrcSpelling,
                         testing::Values(std::pair{"\n", "\r\n"}, std::pair{"\n", "\r"},
                                         std::pair{"^", "\xEF\xBB\xBF"}, std::pair{"\n", "\t\n"},
                                         std::pair{"\n\n", "\n"}, std::pair{"\n\n", "\n\t \n"},
                                         std::pair{"\t\t\t\t4.10", "\tNaN\tnan\t \t4.10"},
                                         std::pair{"\t4\\.00", "\t 4.00 "}, std::pair{"\n$", ""},
                                         std::pair{"\n$", "\n\n"}, std::pair{"4\\.00", "+4e0"},
                                         std::pair{"\t\t\tb\t\t", "\tb"},
                                         std::pair{"2\tmm", "40\tmm"}, std::pair{"Frame#", "Frame"},
                                         std::pair{"0.0[012]0", ""}));

TEST(Trc, ReadsWordsWhereALineHasNoTabs) {
  const std::string text =
      replaced(replaced(replaced(test::tiny_trc, "R Heel", "a"), "\t\t\t4", "\tNaN\tNaN\tnan\t4"),
               "3.2\t\t\t\n", "3.2 nan nan nan\n");

  const Recording recording = parse_trc(replaced(text, "\t+", "   "), "tiny.trc");

  EXPECT_TRUE(same_bits(recording.samples, tiny_samples()));
  EXPECT_EQ(written(recording), replaced(text, "\t+", "   "));
}

TEST(Trc, ReadsEveryRowWhateverNumFramesSaysAndMendsIt) {
  for (const char* count : {"2", "9", "x", "99999999999999999999"}) {
    const std::string text =
        replaced(test::tiny_trc, "\t3\t2\tmm", std::string("\t") + count + "\t2\tmm");

    const Recording recording = parse_trc(text, "tiny.trc");

    EXPECT_EQ(recording.frames(), 3);
    EXPECT_EQ(written(recording), test::tiny_trc);
  }
}

TEST(Trc, ReadsARowThatEndsEarlyAsMissingMarkers) {
  const Recording recording = parse_trc(replaced(test::tiny_trc, "\t\t\t\n$", "\n"), "tiny.trc");

  EXPECT_TRUE(same_bits(recording.samples, tiny_samples()));
  EXPECT_EQ(written(recording), test::tiny_trc);
}

// As Cortex writes them: NumMarkers counts more trajectories than have names.
TEST(Trc, PassesTrajectoriesWithoutANameThrough) {
  std::string text = replaced(test::tiny_trc, "2\tmm", "3\tmm");
  text = replaced(replaced(text, "6.00\n", "6.00\t7\t8\t9\t\n"), "Z2\n", "Z2\tX3\tY3\tZ3\n");

  Recording recording = parse_trc(text, "tiny.trc");

  EXPECT_TRUE(same_bits(recording.samples, tiny_samples()));
  EXPECT_EQ(written(recording), text);
  recording.samples(0, 5) = 6.5;
  EXPECT_EQ(written(recording), replaced(text, "6\\.00", "6.5000"));
}

TEST(Trc, WritesChangedSamplesAloneWithTheDecimalsOfTheFile) {
  const std::string text = replaced(test::tiny_trc, "1\\.50", "1.50000");
  Recording recording = parse_trc(text, "tiny.trc");
  recording.samples(0, 1) = 1. / 3;
  recording.samples(1, 0) = -2;
  recording.samples(2, 2) = nan;

  const std::string expected = replaced(
      replaced(replaced(text, "-2\\.25", "0.33333"), "0\\.010\t", "0.010\t-2.00000"), "3\\.2", "");
  EXPECT_EQ(written(recording), expected);
}

TEST(Trc, KeepsFrameNumbersAndTimesOfTheFramesAskedFor) {
  const TemporaryFolder folder;
  const auto file = folder.file("a.trc", test::tiny_trc);

  const Recording recording =
      read_recording(file, {.skeleton = {}, .frames = {.first = 1, .last = 3}});

  const std::string expected =
      replaced(replaced(test::tiny_trc, "\n1\t.*\n", "\n"), "\t3\t2\tmm", "\t2\t2\tmm");
  write_recording(file, recording);
  EXPECT_EQ(read_file(file), expected);
}

TEST(Trc, WritesOtherRecordingsAsOpenSimReadsThem) {
  const Recording recording{Matrix{{1, 2, 3}, {nan, nan, nan}}, {"a.x", "a.y", "a.z"}, 50, "m"};

  EXPECT_EQ(written(recording),
            "PathFileType\t4\t(X/Y/Z)\tx.trc\n"
            "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\t"
            "OrigDataStartFrame\tOrigNumFrames\n"
            "50\t50\t2\t1\tm\t50\t1\t2\n"
            "Frame#\tTime\ta\t\t\n"
            "\t\tX1\tY1\tZ1\n"
            "\n"
            "1\t0.000000\t1\t2\t3\n"
            "2\t0.020000\t\t\t\n");
}

TEST(Trc, WritesAsfUnitsAsMillimetresAndSaysWhereTheUnitIsUnknown) {
  Recording recording{Matrix{{0.45, 0, 0}}, {"a.x", "a.y", "a.z"}, 50, "ASF units"};
  const Recording asf = parse_trc(written(recording), "x.trc");
  recording.unit = "";

  EXPECT_EQ(asf.unit, "mm");
  EXPECT_NEAR(asf.samples(0, 0), 25.4, 1e-12);
  EXPECT_THAT(written(recording), HasSubstr("\tunknown\t"));
  EXPECT_EQ(parse_trc(written(recording), "x.trc").unit, "");
}

TEST(Trc, RefusesWhatItCannotSay) {
  const auto writing = [](std::vector<std::string> columns, double rate) {
    return [=] { written({Matrix{{1, 2, 3}}, columns, rate, "mm"}); };
  };

  EXPECT_THAT(writing({"a.x", "a.y", "b.z"}, 50),
              ThrowsMessage<FileError>(HasSubstr("column 'a' is no x, y, z of one")));
  EXPECT_THAT(writing({"a\tb.x", "a\tb.y", "a\tb.z"}, 50),
              ThrowsMessage<FileError>(HasSubstr("'a\\x09b' holds a tab")));
  EXPECT_THAT(writing({"a.x", "a.y", "a.z"}, 0),
              ThrowsMessage<FileError>(HasSubstr("needs a frame rate (--rate states it)")));
}

TEST(Trc, LetsTheRateOptionDecideWhereTimeContradictsDataRate) {
  const std::string text = replaced(test::tiny_trc, "100\\.00\t100\\.00", "50\t50");

  const Recording recording = parse_trc(text, "tiny.trc", {.skeleton = {}, .rate = 100});

  EXPECT_THROW(parse_trc(text, "tiny.trc"), FileError);
  EXPECT_EQ(recording.frame_rate, 100);
  const Recording back = parse_trc(written(recording), "tiny.trc");
  EXPECT_EQ(back.frame_rate, 100);
  EXPECT_TRUE(same_bits(back.samples, recording.samples));
}

TEST(Trc, AcceptsTimesOfFewDecimalsAndOfFramesLeftOut) {
  const auto with_times = [](const char* rate, const char* second, const char* third) {
    std::string text = replaced(test::tiny_trc, "100\\.00\t100\\.00", std::string(rate) + "\t0");
    text = replaced(replaced(text, "0\\.010", second), "0\\.020", third);
    return parse_trc(text, "tiny.trc").frame_rate;
  };

  EXPECT_EQ(with_times("120", "0.008", "0.017"), 120);
  EXPECT_EQ(with_times("100", "0.000", "0.000"), 100);
  EXPECT_EQ(with_times("0", "0.010", "0.020"), 0);
}

class TrcTake : public testing::TestWithParam<const char*> {};

TEST_P(TrcTake, ComesBackByteForByte) {
  const auto file = test::shared_data(std::string("trc/") + GetParam());
  MOCLEAN_REQUIRE_FILE(file);

  EXPECT_TRUE(written(read_recording(file)) == read_file(file));
}

INSTANTIATE_TEST_SUITE_P(Real, TrcTake,
                         testing::Values("Gait.trc", "dataWithBlanksForMissingMarkers.trc"));

// As in the example files of OpenSim: blanks before the 4, two tabs between values.
TEST(Trc, ReadsBlanksAndSecondTabsInTheHead) {
  const std::string text =
      "PathFileType  4\t(X/Y/Z) C:\\a b\\\n"
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\n"
      "  100.0\t\t  100.0\t\t      2\t\t      1\t\t mm\t  100.0\n"
      "Frame#\tTime\tA\t\t\n\t\tX1\tY1\tZ1\n\n1\t0.00\t1\t2\t3\n2\t0.01\t4\t5\t6\n";
  const Recording recording = parse_trc(text, "tiny.trc");

  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_EQ(recording.unit, "mm");
  EXPECT_EQ(recording.samples, (Matrix{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(written(recording), text);
}

// Markers that Cortex calculates have names, and columns in rows, but are not counted.
TEST(Trc, ReadsVirtualMarkersBehindThoseThatAreCounted) {
  const std::string head =
      "PathFileType\t4\t(X/Y/Z)\tx.trc\nDataRate\tNumFrames\tNumMarkers\tUnits\n100\t1\t1\tmm\n"
      "Frame#\tTime\tA\t\t\tV_A\t\t\n\t\tX1\tY1\tZ1\n\n";

  const Recording both = parse_trc(head + "1\t0.00\t1\t2\t3\t4\t5\t6\n", "tiny.trc");
  EXPECT_EQ(both.samples, (Matrix{{1, 2, 3, 4, 5, 6}}));
  EXPECT_EQ(written(both), head + "1\t0.00\t1\t2\t3\t4\t5\t6\n");
  EXPECT_THAT(parse_trc(head + "1\t0.00\t1\t2\t3\n", "tiny.trc").columns,
              ElementsAre("A.x", "A.y", "A.z"));
  const std::string labelled = replaced(head, "\tZ1\n", "\tZ1\tX2\tY2\tZ2\n");
  EXPECT_EQ(parse_trc(labelled + "1\t0.00\t1\t2\t3\t\t\t\n", "tiny.trc").samples.cols(), 6);
}

TEST(Trc, ReadsCommasWhereASpreadsheetWroteThem) {
  const std::string text =
      "PathFileType,4,(X/Y/Z),/a b/c.trc,\nDataRate,NumFrames,NumMarkers,Units,\n100,2,2,mm,\n"
      "Frame#,Time,A,,,B,,\n,,X1,Y1,Z1,X2,Y2,Z2\n,,,,,,,\n"
      "1,0,1.5000,2,3,,,\n2,0.01,4,5,6,7,8,9\n";
  Recording recording = parse_trc(text, "tiny.trc");

  EXPECT_EQ(recording.unit, "mm");
  EXPECT_TRUE(same_bits(recording.samples, Matrix{{1.5, 2, 3, nan, nan, nan}, {4, 5, 6, 7, 8, 9}}));
  EXPECT_EQ(written(recording), text);
  recording.samples.row(0).tail(3) << 7, 8.5, 9;
  const std::string filled = written(recording);
  EXPECT_NE(filled.find("1,0,1.5000,2,3,7.0000,8.5000,9.0000\n"), filled.npos) << filled;
}

}  // namespace
}  // namespace moclean
