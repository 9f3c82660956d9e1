// Tables that have more to understand than a line of names: separators within names, heads of
// several levels, a row per point, numbers that are none.
#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "formats/table_text.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::same_bits;
using test::table;
using test::written_again;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

void expect_refusal(const std::string& text, const std::string& message,
                    const ReadOptions& options = {}) {
  EXPECT_THAT([&] { table(text, options); }, ThrowsMessage<FileError>(HasSubstr(message))) << text;
}

class SeparatorsInNames : public testing::TestWithParam<std::string> {};

TEST_P(SeparatorsInNames, DoNotSeparate) {
  const Recording recording = table(GetParam());

  EXPECT_THAT(recording.columns, ElementsAre("Hips.x", "Hips.y"));
  EXPECT_EQ(recording.samples, (Matrix{{1.5, 2}, {3.5, 4}}));
  EXPECT_EQ(written_again(recording), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Spellings, SeparatorsInNames,
                         testing::Values("\"Hips, x\";\"Hips, y\"\n1,5;2\n3,5;4\n",
                                         "Hips, x;Hips, y\n1,5;2\n3,5;4\n",
                                         "\"Hips, x\";\"Hips, y\"\n1.5;2\n3.5;4\n",
                                         "\"Hips, x\",\"Hips, y\"\n1.5,2\n3.5,4\n",
                                         "\"Hips, x\"\t\"Hips, y\"\n1,5\t2\n3,5\t4\n",
                                         "\"Hips; x\",\"Hips; y\"\n\"1,5\",2\n\"3,5\",4\n",
                                         "Hips_x;Hips_y;note\n1,5;2;\"a,b\"\n3,5;4;\n"));

class LevelHeads : public testing::TestWithParam<std::string> {};

// As DataFrame.to_csv() writes columns of several levels, in any order, with and without names of
// the levels and of the index.
TEST_P(LevelHeads, AreReadAndComeBack) {
  Recording recording = table(GetParam());

  EXPECT_THAT(recording.columns,
              testing::UnorderedElementsAre("nose.x", "nose.y", "ear.x", "ear.y"));
  EXPECT_EQ(recording.samples, (Matrix{{1, 2, 3, 4}, {5, 6, 7, 8}}));
  EXPECT_THAT(recording.notes.layout, HasSubstr("2 points of two coordinates"));
  EXPECT_EQ(written_again(recording), GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Spellings, LevelHeads,
    testing::Values(
        "bodypart,nose,nose,ear,ear\ncoord,x,y,x,y\nframe,,,,\n0,1,2,3,4\n1,5,6,7,8\n",
        "bodypart,nose,nose,ear,ear\ncoord,x,y,x,y\n0,1,2,3,4\n1,5,6,7,8\n",
        ",nose,nose,ear,ear\n,x,y,x,y\n0,1,2,3,4\n1,5,6,7,8\n",
        ",nose,nose,ear,ear\n,x,y,x,y\nframe,,,,\n0,1,2,3,4\n1,5,6,7,8\n",
        ",x,y,x,y\nkeypoint,nose,nose,ear,ear\nframe,,,,\n0,1,2,3,4\n1,5,6,7,8\n",
        "coords,x,y,x,y\nbodyparts,nose,nose,ear,ear\n0,1,2,3,4\n1,5,6,7,8\n",
        "scorer;net;net;net;net\npart;nose;nose;ear;ear\ncoord;x;y;x;y\n0;1;2;3;4\n1;5;6;7;8\n",
        "part,,nose,nose,ear,ear\ncoord,,x,y,x,y\nframe,time,,,,\n0,0,1,2,3,4\n1,0.1,5,6,7,8\n"));

TEST(LevelHeads, OfAPivotHaveAllXBeforeAllY) {
  const std::string text =
      ",x,x,y,y,likelihood,likelihood\nkeypoint,ear,nose,ear,nose,ear,nose\nframe,,,,,,\n"
      "0,1,2,3,4,0.5,0\n1,5,6,7,8,0.5,1\n";
  const Recording recording = table(text);

  EXPECT_THAT(recording.columns, ElementsAre("ear.x", "ear.y", "nose.x", "nose.y"));
  EXPECT_TRUE(same_bits(recording.samples, Matrix{{1, 3, test::nan, test::nan}, {5, 7, 6, 8}}));
}

TEST(LevelHeads, NameLevelsThatDiffer) {
  EXPECT_THAT(table("animal,a,a,b,b\npart,nose,nose,nose,nose\ncoord,x,y,x,y\n0,1,2,3,4\n").columns,
              ElementsAre("a.x", "a.y", "b.x", "b.y"));
  EXPECT_THAT(table("animal,a,a,b,b\npart,nose,nose,ear,ear\ncoord,x,y,x,y\n0,1,2,3,4\n").columns,
              ElementsAre("a:nose.x", "a:nose.y", "b:ear.x", "b:ear.y"));
}

TEST(LongTables, AreRefusedWithAWordHowToMakeColumnsOfPoints) {
  expect_refusal(
      "frame,keypoint,x,y,z,likelihood\n0,nose,1,2,3,1\n0,ear,1,2,3,1\n1,nose,1,2,3,1\n",
      "tiny.csv:3: expected a row per frame, found a row per point, which column 2 ('keypoint') "
      "names: make columns of the points, in pandas with table.pivot(index='frame', "
      "columns='keypoint', values=['x', 'y', 'z', 'likelihood'])");
  const ReadOptions rate{.skeleton = {}, .rate = 30};
  expect_refusal("keypoint;x;y\nnose;1,5;2\near;1;2\n", "a row per point", rate);
  expect_refusal("frame_idx,landmark_id,x,y,z\n0,0,1,2,3\n0,1,1,2,3\n", "'landmark_id'", rate);
  expect_refusal("track,frame_idx,nose.x,nose.y\na,0,1,2\nb,0,1,2\n", "column 1 ('track')", rate);
  expect_refusal("Marker Name,Frame,X,Y,Z\nLFHD,1,1,2,3\nLFHD,2,1,2,3\nRFHD,1,1,2,3\n",
                 "tiny.csv:4: expected a row per frame", rate);
}

// Whatever the column is called that tells rows of one frame apart, if it has text.
TEST(LongTables, AreKnownByRowsOfOneFrame) {
  const ReadOptions rate{.skeleton = {}, .rate = 30};
  expect_refusal("part,x,y,frame\nnose,1,2,0\nnose,1,2,1\near,1,2,0\near,1,2,1\n",
                 "tiny.csv:4: expected a row per frame, found a row per point, which column 1 "
                 "('part') names",
                 rate);
  expect_refusal("time,who,a_x,a_y,b_x,b_y,c_x,c_y\n0,A,1,2,3,4,5,6\n0,B,1,2,3,4,5,6\n",
                 "column 2 ('who')", rate);
  expect_refusal(
      "track,frame_idx,score,a.x,a.y,b.x,b.y,c.x,c.y\n"
      "0,0,1,1,2,3,4,5,6\n1,0,1,1,2,3,4,5,6\n",
      "column 1 ('track')", rate);
  expect_refusal("frame,marker,axis,value\n0,A,x,1\n0,A,y,2\n", "column 3 ('axis')", rate);
  expect_refusal("frame,speed\n0,1\n0,2\n", "expected a frame after 0, found 0");
}

TEST(LongTables, AreNotThoseOfOnePointAloneOrOfWideOnes) {
  EXPECT_EQ(table("frame,keypoint,x,y\n0,nose,1,2\n1,nose,3,4\n").frames(), 2);
  EXPECT_EQ(table("frame,label,x,y\n0,walk,1,2\n1,run,3,4\n").frames(), 2);
  EXPECT_EQ(table("track,a_x,a_y,b_x,b_y,c_x,c_y\n1,1,2,3,4,5,6\n2,1,2,3,4,5,6\n").frames(), 2);
  EXPECT_EQ(table("point,x,y\n7,1,2\n8,3,4\n", {.skeleton = {}, .columns = "oxy"}).frames(), 2);
}

TEST(TextTables, AreThoseOfNumpy) {
  const std::string numbers = "1.500000000000000000e+00 2.000000000000000000e+00 nan\n4 5 6\n";
  const std::string named = "# A.x A.y A.z\n" + numbers;
  const auto read = [](const std::string& text, const ReadOptions& options = {}) {
    const test::TemporaryFolder folder;
    return read_recording(folder.file("a.txt", text), options);
  };
  const Recording recording = read(named);

  EXPECT_THAT(recording.columns, ElementsAre("A.x", "A.y", "A.z"));
  EXPECT_TRUE(same_bits(recording.samples, Matrix{{1.5, 2, test::nan}, {4, 5, 6}}));
  EXPECT_EQ(written_again(recording, "a.txt"), named);
  EXPECT_EQ(written_again(recording, "a.csv"), "A.x,A.y,A.z\n1.5,2,nan\n4,5,6\n");
  EXPECT_THAT([&] { read(numbers); },
              ThrowsMessage<FileError>(HasSubstr("a.txt:1: expected a line of column names")));
  EXPECT_EQ(read(numbers, {.skeleton = {}, .layout = ColumnLayout::points3}).columns[0],
            "point1.x");
}

TEST(TextTables, MayHaveANameOverTheAxesOfItsPoint) {
  EXPECT_THAT(table("mass_A\nt\tx\ty\n0.00\t1\t2\n0.01\t3\t4\n").columns,
              ElementsAre("mass_A.x", "mass_A.y"));
}

TEST(TextTables, OfOtherRecordingsHaveTabs) {
  EXPECT_EQ(written_again({Matrix{{1, 2}}, {"A.x", "A.y"}, 50, "mm"}, "a.txt"),
            "# frame_rate: 50\n# unit: mm\nA.x\tA.y\n1\t2\n");
}

TEST(TableNumbers, OfInfiniteSizeAreRefusedByLine) {
  expect_refusal("A.x,A.y\n1,2\n3,inf\n",
                 "tiny.csv:3: expected a finite number, found 'inf' in column 2 ('A.y')");
  expect_refusal("A.x;A.y\n1,5;2\n-Infinity;2\n", "tiny.csv:3: expected a finite number");
  expect_refusal("a,b\n1,2\n\"inf\",2\n", "tiny.csv:3: expected a finite number, found '\"inf\"'");
  expect_refusal("a,b\n1,2\n1e999,2\n", "tiny.csv:3: expected a number, found '1e999'");
  EXPECT_EQ(table("A.x,A.y,error\n1,2,inf\n").frames(), 1);  // passes through
}

// Confidences that are all 0 are not used: in a part of the frames they tell nothing.
TEST(TableConfidences, KeepAPointMissingInAPartWhereNoneIsAboveZero) {
  const Recording take = table("A_x,A_y,A_score\n1,2,0\n3,4,0\n5,6,1\n");

  const std::string part = written_again(excerpt(take, 0, 2));

  EXPECT_EQ(part, "A_x,A_y,A_score\n,,0\n,,0\n");
  EXPECT_TRUE(table(part).samples.array().isNaN().all());
  EXPECT_EQ(written_again(excerpt(take, 1, 3)), "A_x,A_y,A_score\n3,4,0\n5,6,1\n");
}

}  // namespace
}  // namespace moclean
