#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/table_document.hpp"

#include "formats/table_text.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::same_bits;
using test::table;
using test::written_again;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

void expect_failure(const std::string& text, const std::string& message,
                    const ReadOptions& options = {}) {
  EXPECT_THAT([&] { table(text, options); }, ThrowsMessage<FileError>(HasSubstr(message))) << text;
}

std::string repeated(std::string_view text, int times) {
  std::string all;
  for (; times > 0; --times) all += text;
  return all;
}

std::string utf16(std::string_view ascii, bool is_little) {
  std::string bytes;
  for (const char c : ascii) bytes += is_little ? std::string{c, '\0'} : std::string{'\0', c};
  return bytes;
}

class TableSpelling : public testing::TestWithParam<std::string> {};

// The samples are 1.5, 2, missing / 4, 5, 6 however they are spelled.
TEST_P(TableSpelling, IsReadAndComesBackByteForByte) {
  const Recording recording = table(GetParam());

  EXPECT_THAT(recording.columns, ElementsAre("A.x", "A.y", "A.z"));
  EXPECT_TRUE(same_bits(recording.samples, Matrix{{1.5, 2, test::nan}, {4, 5, 6}}));
  EXPECT_EQ(written_again(recording), GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Ends, TableSpelling,
    testing::Values("A.x,A.y,A.z\n1.5,2,\n4,5,6\n", "A.x,A.y,A.z\n1.5,2,\n4,5,6",
                    "A.x,A.y,A.z\r\n1.5,2,nan\r\n4,5,6\r\n", "A.x,A.y,A.z\r1.5,2,\r4,5,6\r",
                    "\n# c\n\nA.x,A.y,A.z\n\n1.5,2,\n# in between\n \n4,5,6\n\n\n",
                    "\xEF\xBB\xBF"
                    "A.x,A.y,A.z\n1.5,2,\n4,5,6\n"));

INSTANTIATE_TEST_SUITE_P(
    Separators, TableSpelling,
    testing::Values("A.x;A.y;A.z\n1.5;2;\n4;5;6\n", "A.x;A.y;A.z\n1,5;2;\n4;5;6\n",
                    "A.x\tA.y\tA.z\n1,50\t2\t\n4\t5,0\t6\n", "A.x A.y A.z\n1.5 2 nan\n 4  5  6\n",
                    "sep=;\nA.x;A.y;A.z\n1,5;2;\n4;5;6\n",
                    "\"sep=|\"\nA.x|A.y|A.z\n1.5|2|\n4|5|6\n",
                    "A.x , A.y , A.z\n 1.5,\t2 ,\n+4 , 5e0, 6.\n",
                    "A.x,A.y,A.z,\n1.5,2,,\n4,5,6,\n", "A.x,A.y,A.z\n1.5,2,,\n4,5,6,,\n",
                    "A.x,A.y,A.z,,\n1.5,2,\n4,5,6,\n"));

INSTANTIATE_TEST_SUITE_P(
    Quotes, TableSpelling,
    testing::Values("\"A.x\",\"A.y\",\"A.z\"\n1.5,2,\n4,5,6\n",
                    "\"A.x\",\"A.y\",\"A.z\"\n\"1.5\",\"2\",\"\"\n\"4\",\"5\",\"6\"\n",
                    "A.x,A.y,A.z\n\"1,5\",\"2\",NA\n4,5,6\n",
                    "A.x,A.y,A.z,note\n1.5,2,,\"a, \"\"b\"\"\"\n4,5,6,\n"));

INSTANTIATE_TEST_SUITE_P(Heads, TableSpelling,
                         testing::Values("A.x,A.y,A.z\nmm,mm,mm\n1.5,2,\n4,5,6\n",
                                         "A.x,A.y,A.z\n[mm],[mm],[mm]\n1.5,2,\n4,5,6\n",
                                         "A,,\nX,Y,Z\n1.5,2,\n4,5,6\n",
                                         ",A,,\nFrame,x,y,z\n,mm,mm,mm\n1,1.5,2,\n2,4,5,6\n",
                                         "\"A.x\" \"A.y\" \"A.z\"\n\"1\" 1.5 2 NA\n\"2\" 4 5 6\n",
                                         "# made by numpy\n# A.x,A.y,A.z\n1.5,2,nan\n4,5,6\n",
                                         "#A.x A.y A.z\n1.5 2 nan\n4 5 6\n"));

INSTANTIATE_TEST_SUITE_P(Missing, TableSpelling, testing::ValuesIn([] {
                           std::vector<std::string> texts;
                           for (const char* word :
                                {"nan",       "NaN",     "-nan",      "-nan(ind)", "1.#IND",
                                 "-1.#IND00", "1.#QNAN", "-1.#QNAN0", "NA",        "N/A",
                                 "#N/A",      "#NUM!",   "<NA>",      ".",         "missing",
                                 "null",      "NULL",    "None",      "-",         "--",
                                 "\"\"",      " "})
                             texts.push_back(fmt::format("A.x,A.y,A.z\n1.5,2,{}\n4,5,6\n", word));
                           return texts;
                         }()));

INSTANTIATE_TEST_SUITE_P(
    Encodings, TableSpelling,
    testing::Values("\xFF\xFE" + utf16("A.x\tA.y\tA.z\r\n1.5\t2\t\r\n4\t5\t6\r\n", true),
                    "\xFE\xFF" + utf16("A.x,A.y,A.z\n1.5,2,\n4,5,6\n", false),
                    utf16("A.x,A.y,A.z\n1.5,2,\n4,5,6\n", true),
                    utf16("A.x,A.y,A.z\n1.5,2,\n4,5,6\n", false)));

TEST(Table, KeepsEveryCharacterOfUtf16) {
  // ae, Greek omega, a clef beyond 16 bits, half a pair of surrogates.
  using namespace std::string_literals;
  const std::string names = "\xE6\0\xC9\x03\x34\xD8\x1E\xDD\x00\xD8"s;
  const std::string text = "\xFF\xFE" + utf16("A.x,A.y,note ", true) + names +
                           utf16("\n1,2,\n3,4,", true) + names + utf16("\n", true);

  EXPECT_EQ(written_again(table(text)), text);
}

TEST(Table, RefusesHalfACharacterOfUtf16) {
  expect_failure("\xFF\xFE" + utf16("a,b\n1,2\n", true) + "3",
                 "expected two bytes per character (UTF-16), found an odd number");
}

// All that is no sample stays where it is, whatever is done to the samples.
TEST(Table, WritesChangedSamplesAloneInTheirPlaces) {
  const std::string text =
      "# made by hand\n# frame_rate: 50.0\nframe,A_z,A_x,A_y,note,time,\n"
      "7,1.50,2.0,3,a,0.00,\n8,,5,6.000,\"b, c\",0.02,\n9,7,8,9,,0.04,\n";
  Recording recording = table(text);
  ASSERT_TRUE(same_bits(recording.samples, Matrix{{2, 3, 1.5}, {5, 6, test::nan}, {8, 9, 7}}));

  recording.samples(0, 2) = 1.25;
  recording.samples(1, 2) = -1. / 3;
  recording.samples(2, 0) = test::nan;

  EXPECT_EQ(written_again(recording),
            "# made by hand\n# frame_rate: 50.0\nframe,A_z,A_x,A_y,note,time,\n"
            "7,1.25,2.0,3,a,0.00,\n8,-0.3333333333333333,5,6.000,\"b, c\",0.02,\n9,7,,9,,0.04,\n");
  EXPECT_THAT(recording.notes.passed_through, ElementsAre("frame", "note", "time"));
}

TEST(Table, SpellsChangedSamplesAsTheFileDoes) {
  Recording commas = table("A.x;A.y\n1,5;\"2,5\"\nNA;4\n");
  commas.samples << 1.25, 2.75, 3.5, test::nan;
  EXPECT_EQ(written_again(commas), "A.x;A.y\n1,25;\"2,75\"\n3,5;NA\n");

  Recording quoted = table("A.x,A.y\n\"1,5\",2\n3,4\n");
  quoted.samples(1, 0) = 0.5;
  EXPECT_EQ(written_again(quoted), "A.x,A.y\n\"1,5\",2\n\"0,5\",4\n");

  Recording words = table("A.x A.y\n1 2\n3 4\n");
  words.samples(0, 1) = test::nan;
  EXPECT_EQ(written_again(words), "A.x A.y\n1 nan\n3 4\n");

  Recording wide = table(utf16("A.x,A.y\n1,2\n", true));
  wide.samples(0, 1) = 2.5;
  EXPECT_EQ(written_again(wide), utf16("A.x,A.y\n1,2.5\n", true));
}

TEST(Table, KeepsMarksThatAreStillMissing) {
  const test::TemporaryFolder folder;
  const std::string text = "A.x,A.y\n0,0\n1,0\n-9999,5\n7,8\n";
  const ReadOptions options{.skeleton = {}, .missing = {0, -9999}};
  Recording recording = read_recording(folder.file("a.csv", text), options);
  ASSERT_TRUE(same_bits(recording.samples,
                        Matrix{{test::nan, test::nan}, {1, 0}, {test::nan, test::nan}, {7, 8}}));

  write_recording(folder.path() / "same.csv", recording);
  recording.samples.row(2) << 3, 5;
  recording.samples.row(3).setConstant(test::nan);
  write_recording(folder.path() / "other.csv", recording);

  EXPECT_EQ(read_file(folder.path() / "same.csv"), text);
  EXPECT_EQ(read_file(folder.path() / "other.csv"), "A.x,A.y\n0,0\n1,0\n3,5\n0,0\n");
}

TEST(Table, TakesAPointOfNoConfidenceForMissing) {
  const std::string text = "A_x,A_y,A_score,B_x,B_y,B_score\n1,2,0,5,6,0.5\n3,4,0.1,7,8,0.0\n";
  Recording recording = table(text);

  EXPECT_TRUE(same_bits(recording.samples,
                        Matrix{{test::nan, test::nan, 5, 6}, {3, 4, test::nan, test::nan}}));
  EXPECT_TRUE(same_bits(recording.confidence, Matrix{{test::nan, test::nan, 0.5, 0.5},
                                                     {0.1, 0.1, test::nan, test::nan}}));
  EXPECT_THAT(recording.notes.layout, HasSubstr("weighed by their confidences"));
  EXPECT_EQ(written_again(recording), text);
}

// Its readers, this program too, would leave a filled point out again.
TEST(Table, GivesAFilledPointTheLeastConfidenceThereIs) {
  Recording recording =
      table("A_x,A_y,A_score,B_x,B_y,B_score\n1,2,0,5,6,\"0.50\"\n3,4,0.1,7,8,\"0\"\n");
  recording.samples(0, 0) = 1.5;
  EXPECT_EQ(written_again(recording),
            "A_x,A_y,A_score,B_x,B_y,B_score\n1.5,2,0,5,6,\"0.50\"\n3,4,0.1,7,8,\"0\"\n");

  recording.samples << 1.5, 2, 5, 6, 3, 4, 7, 8;
  const std::string filled = written_again(recording);

  EXPECT_EQ(filled,
            "A_x,A_y,A_score,B_x,B_y,B_score\n1.5,2,0.1,5,6,\"0.50\"\n3,4,0.1,7,8,\"0.1\"\n");
  EXPECT_EQ(table(filled).samples, recording.samples);
}

TEST(Table, DoesNotUseAConfidenceThatIsAlwaysZero) {
  const Recording recording = table("A_x,A_y,A_visibility\n1,2,0\n3,4,0.0\n");

  EXPECT_EQ(recording.samples, (Matrix{{1, 2}, {3, 4}}));
  EXPECT_EQ(recording.confidence.size(), 0);
  EXPECT_THAT(recording.notes.warnings, ElementsAre("every confidence is 0: they are not used"));
}

TEST(Table, WritesTheFramesThereAre) {
  const std::string text = "# head\ni,A.x,A.y\n\n0,1,2\n1,3,4\n# two\n2,5,6\n3,7,8\n";
  const Recording all = table(text);

  EXPECT_EQ(written_again(excerpt(all, 1, 3)), "# head\ni,A.x,A.y\n1,3,4\n# two\n2,5,6\n");
  EXPECT_EQ(written_again(excerpt(excerpt(all, 1, 4), 1, 3)), "# head\ni,A.x,A.y\n2,5,6\n3,7,8\n");
  EXPECT_EQ(written_again(excerpt(all, 0, 4)), text);
}

TEST(Table, StatesAnotherRateWhereItStatesOne) {
  Recording recording = table("# frame_rate: 120\na,b\n1,2\n", {.skeleton = {}, .rate = 59.94});

  EXPECT_EQ(written_again(recording), "# frame_rate: 59.94\na,b\n1,2\n");
  EXPECT_THAT(recording.notes.warnings, ElementsAre("the file tells 120 Hz, --rate 59.94 is used"));
}

TEST(Table, IsWrittenAnewWhereTheTextIsOfNoUse) {
  const Recording recording = table("# frame_rate: 100\nA_x;A_y;n\n1;2;3\n4;5;6\n7;8;9\n");

  EXPECT_EQ(written_again(thinned(recording, 2)), "# frame_rate: 50\nA.x,A.y\n1,2\n7,8\n");
  EXPECT_EQ(written_again(recording, "out.tsv"), "# frame_rate: 100\nA.x\tA.y\n1\t2\n4\t5\n7\t8\n");
}

TEST(Table, KeepsASpreadsheetFromExecutingNames) {
  const Recording recording{Matrix{{1, 2, 3}}, {"=1+2", "-5", "@\"x"}, 0, ""};

  const std::string text = written_again(recording);

  EXPECT_EQ(text, "\"'=1+2\",-5,\"'@\"\"x\"\n1,2,3\n");
  EXPECT_EQ(table(text).columns, recording.columns);
}

TEST(Table, WritesNamesThatAreAllNumbersSoThatTheyAreNoRow) {
  const Recording recording{Matrix{{5, 6, 7}}, {"1", "-2.5", "nan"}, 0, ""};

  const std::string text = written_again(recording);

  EXPECT_EQ(text, "\"'1\",\"'-2.5\",nan\n5,6,7\n");
  EXPECT_EQ(table(text).columns, recording.columns);
  EXPECT_EQ(table(text).samples, recording.samples);
}

TEST(Table, TakesRowNamesOfRForNoSamplesEvenIfTheyDoNotCount) {
  EXPECT_EQ(table("a,b\n1,5,2\n").samples, (Matrix{{5, 2}}));
  EXPECT_EQ(table("a,b\n1,5,2\n7,6,3\n3,6,4\n").samples, (Matrix{{5, 2}, {6, 3}, {6, 4}}));
}

TEST(Table, ReadsOneRowOfWordsUnderNamesInAComment) {
  const Recording recording = table("# A.x A.y A.z\n4 5 6\n");

  EXPECT_THAT(recording.columns, ElementsAre("A.x", "A.y", "A.z"));
  EXPECT_EQ(recording.samples, (Matrix{{4, 5, 6}}));
}

TEST(Table, PassesTextThroughAndRefusesItAmongNumbers) {
  EXPECT_THAT(table("a,who\n1,me\n2,you\n").columns, ElementsAre("a"));
  EXPECT_THAT(table("clock,A.x,A.y\n10:00,1,2\n10:01,1,2\n").notes.passed_through,
              ElementsAre("clock"));
  expect_failure("a,b\n1,2\n3,4\nx,5\n",
                 "tiny.csv:4: expected a number, found 'x' in column 1 ('a')");
  expect_failure("a,b\nx,2\n3,4\n", "tiny.csv:2: expected a number, found 'x' in column 1 ('a')");
  expect_failure("A.x,A.y\nlow,2\nhigh,4\n", "tiny.csv:2: expected a number, found 'low'");
  expect_failure("a,b\nlow,high\n", "tiny.csv:2: expected a number, found 'low'");
}

TEST(Table, RefusesRowsOfOtherLengths) {
  expect_failure("a,b,c\n1,2,3\n1,2\n", "tiny.csv:3: expected 3 columns, found 2");
  expect_failure("a,b,c\n1,2,3\n\n1,2,3,4\n", "tiny.csv:4: expected 3 columns, found 4");
  expect_failure("# c\na b c\n1 2 3\n1 2\n", "tiny.csv:4: expected 3 columns, found 2");
  expect_failure("A.x,A.y\n1,5,2,5\n",
                 "tiny.csv:2: expected 2 columns, found 4: if the comma is both separator and "
                 "decimal mark, separate by ; or tab");
}

TEST(Table, OfAHundredThousandQuotesOrEqualNamesTakesNoLong) {
  expect_failure("a,b\n" + std::string(200000, '"') + "\n", "tiny.csv:2: expected a number");

  std::string names = "NO_OF_FRAMES\t1\nMARKER_NAMES", row;
  for (int i = 0; i < 50000; ++i) names += "\ta", row += i == 0 ? "1\t2\t3" : "\t1\t2\t3";
  const Recording recording = table(names + "\n" + row + "\n");

  EXPECT_EQ(recording.columns.back(), "a_50000.z");
}

TEST(Table, TakesSeparatorsAloneAtItsEndForNoFrames) {
  const std::string text = "time,A.x,A.y\r\n0,1,2\r\n1,,\r\n,,\r\n,,\r\n\r\n";
  const Recording recording = table(text);

  EXPECT_EQ(recording.frames(), 2);
  EXPECT_THAT(recording.notes.warnings,
              testing::Contains("2 lines of separators alone at the end, no frames"));
  EXPECT_EQ(written_again(recording), text);
  EXPECT_EQ(table("a,b\n,\n,\n").frames(), 2);
  EXPECT_EQ(table("a,b\n,\n1,2\n").frames(), 2);
}

TEST(Table, TellsAPointFromACommaInAnyRow) {
  EXPECT_EQ(table("a;b\n1;2\n3;4,5\n").samples(1, 1), 4.5);
  EXPECT_EQ(table("a;b\n1;2\n3;4.5\n").samples(1, 1), 4.5);
  expect_failure("a;b\n1.5;2\n3;4,5\n", "tiny.csv:3: expected a decimal point, as in other cells");
  expect_failure("a;b\n1,5;2\n" + repeated("1;2\n", 50) + "3;4.5\n",
                 "tiny.csv:53: expected a decimal comma, as in other cells, found '4.5'");
  EXPECT_EQ(table("A.x;A.y;version\n1,5;2;1.25\n").samples(0, 0), 1.5);
}

TEST(Table, TakesTheRateFromTimesOfAnyUnit) {
  const auto rate = [](const char* name, double first, double step) {
    std::string text = fmt::format("{},a\n", name);
    for (int f = 0; f < 10; ++f) text += fmt::format("{:.6f},1\n", first + f * step);
    return table(text).frame_rate;
  };

  EXPECT_EQ(rate("Time (Seconds)", 0, 0.01), 100);
  EXPECT_EQ(rate("time_ms", 0, 10), 100);
  EXPECT_EQ(rate("t [ms]", 0, 1), 1000);
  EXPECT_EQ(rate("timestamp", 1700000000, 0.01), 100);
  EXPECT_EQ(rate("timestamp", 1700000000000, 10), 100);
  EXPECT_EQ(rate("timestamp", 1700000000000000, 10000), 100);
  EXPECT_EQ(rate("time", 0, 33.333333), 30);
  EXPECT_EQ(rate("time", 3, 1), 0);
  EXPECT_EQ(rate("time_s", 3, 1), 1);
  EXPECT_NEAR(rate("time", 0, 1 / 59.94), 59.94, 1e-3);
}

TEST(Table, RefusesTimesAndFramesThatDoNotGrow) {
  expect_failure("a,Time\n1,0.0\n1,0.0\n",
                 "tiny.csv:3: expected a time after 0, found 0 in column 2 ('Time'): are the times "
                 "printed with too few digits? --rate states the rate");
  expect_failure("a,time\n1,2\n1,1.5\n", "tiny.csv:3: expected a time after 2, found 1.5");
  expect_failure("a,time\n1,\n1,1.5\n", "tiny.csv:2: expected a time in column 2 ('time')");
  expect_failure(
      "frame,a\n0,1\n0,3\n",
      "tiny.csv:3: expected a frame after 0, found 0 in column 1 ('frame'): a table with "
      "several rows of one frame, or of several takes, is not read");
  EXPECT_EQ(table("a,Time\n1,0\n1,0\n", {.skeleton = {}, .rate = 50}).frame_rate, 50);
}

TEST(Table, WarnsOfATimeColumnThatContradictsTheStatedRate) {
  const Recording recording = table("# frame_rate: 50\ntime,a\n0,1\n0.01,2\n");

  EXPECT_EQ(recording.frame_rate, 50);
  EXPECT_THAT(recording.notes.warnings,
              ElementsAre("time tells 100 Hz, the stated rate of 50 Hz is used"));
  EXPECT_THAT(table("# frame_rate: 99\ntime,a\n0,1\n0.01,2\n").notes.warnings, IsEmpty());
}

TEST(Table, TakesTheUnitFromNamesOrTheLineUnderThem) {
  EXPECT_EQ(table("A X (mm),A Y (mm)\n1,2\n").unit, "mm");
  EXPECT_EQ(table("t,A_x,A_y\ns,m,m\n0,1,2\n").unit, "m");
  EXPECT_EQ(table("A X (mm),A Y (cm)\n1,2\n").unit, "");
  EXPECT_EQ(table("# unit: in\nA X (mm),A Y (mm)\n1,2\n").unit, "in");
}

TEST(Table, FollowsColumnsAndLayoutOfTheOptions) {
  const std::string numbers = "0.00,1,2,3,9\n0.01,4,5,6,9\n";
  ReadOptions options{.skeleton = {}, .columns = "txyzo"};

  const Recording recording = table(numbers, options);
  EXPECT_THAT(recording.columns, ElementsAre("point1.x", "point1.y", "point1.z"));
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_EQ(recording.notes.layout,
            "1 point of three coordinates, as --columns says; time in column 1, 100 Hz");
  EXPECT_EQ(written_again(recording), numbers);
  EXPECT_THAT(table("1 2 3\n4 5 6\n", {.skeleton = {}, .layout = ColumnLayout::points3}).columns,
              ElementsAre("point1.x", "point1.y", "point1.z"));
  EXPECT_THAT(table("A.x,A.y\n1,2\n", {.skeleton = {}, .layout = ColumnLayout::plain}).columns,
              ElementsAre("A.x", "A.y"));
  expect_failure(numbers, "tiny.csv:1: expected a line of column names, found numbers; --columns");
}

TEST(Table, SaysWhatItUnderstood) {
  EXPECT_EQ(table("Frame,Time,S:A:X,S:A:Y,S:A:Z\n1,0,1,2,3\n2,0.01,1,2,3\n").notes.layout,
            "1 point of three coordinates (names like 'S:A:X'); time in column 2, 100 Hz");
  EXPECT_EQ(table("timestamp,a\n0,1\n20,2\n").notes.layout,
            "1 channel; no names tell of points; time in column 1 in milliseconds, 50 Hz");
}

}  // namespace
}  // namespace moclean
