// Tables of programs that have a head of their own: small ones as each program writes them.
#include <gmock/gmock.h>

#include "formats/named_tables.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::replaced;
using test::same_bits;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::ThrowsMessage;

class TableHeads : public test::NamedTables {};

// Two labelled markers, a rigid body with its own, and a bone.
const std::string motive_csv =
    "Format Version,1.23,Take Name,walk,Take Notes,,Capture Frame Rate,120.000000,"
    "Export Frame Rate,100.000000,Capture Start Time,2021-01-01 10.00.00.000 AM,"
    "Capture Start Frame,0,Total Frames in Take,300,Total Exported Frames,2,"
    "Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global\n"
    "\n"
    ",Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid "
    "Body,Bone,Bone,Bone,Marker,Marker,Marker,Marker,Marker,Marker\n"
    ",Name,RB,RB,RB,RB,RB,RB,RB,RB,S:Hip,S:Hip,S:Hip,S:LFHD,S:LFHD,S:LFHD,\"S:R,HD\",\"S:R,HD\","
    "\"S:R,HD\"\n"
    ",ID,\"1\",\"1\",\"1\",\"1\",\"1\",\"1\",\"1\",\"1\",\"2\",\"2\",\"2\",\"3\",\"3\",\"3\",\"4\","
    "\"4\",\"4\"\n"
    ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker Error,Position,"
    "Position,Position,Position,Position,Position,Position,Position,Position\n"
    "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z,X,Y,Z,X,Y,Z\n"
    "0,0.000000,0,0,0,1,0.1,0.2,0.3,0.001,9,9,9,1.500000,2.500000,3.500000,4,5,6\n"
    "1,0.010000,0,0,0,1,0.1,0.2,0.3,0.001,9,9,9,,,,4.1,5.1,6.1\n";

TEST_F(TableHeads, OfMotiveHaveTheirMarkersCleaned) {
  Recording recording = read("a.csv", motive_csv);

  EXPECT_THAT(recording.columns,
              ElementsAre("S:LFHD.x", "S:LFHD.y", "S:LFHD.z", "S:R,HD.x", "S:R,HD.y", "S:R,HD.z"));
  EXPECT_TRUE(same_bits(
      recording.samples,
      Matrix{{1.5, 2.5, 3.5, 4, 5, 6}, {test::nan, test::nan, test::nan, 4.1, 5.1, 6.1}}));
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_EQ(recording.unit, "m");
  EXPECT_EQ(recording.notes.layout,
            "Motive CSV: 2 points of three coordinates; time in column 2, 100 Hz");
  EXPECT_THAT(recording.notes.passed_through,
              IsSupersetOf({"Frame", "Time (Seconds)", "RB Rotation W", "RB Position X",
                            "RB Mean Marker Error", "S:Hip Position Z"}));

  EXPECT_EQ(write("b.csv", recording), motive_csv);
  recording.samples(1, 1) = 2.25;
  EXPECT_EQ(write("b.csv", recording), replaced(motive_csv, "9,9,9,,,,", "9,9,9,,2.25,,"));
  EXPECT_EQ(write("b.csv", excerpt(read("a.csv", motive_csv), 0, 1)),
            replaced(replaced(motive_csv, "Exported Frames,2", "Exported Frames,1"),
                     "1,0.010000,0,0,0,1,0.1,0.2,0.3,0.001,9,9,9,,,,4.1,5.1,6.1\n", ""));
}

TEST_F(TableHeads, OfMotiveWithoutMarkersHaveBodiesForPoints) {
  const std::string text =
      "Format Version,1.1,Take Name,x,Export Frame Rate,50,Length Units,Millimeters\n\n"
      ",Type,Bone,Bone,Bone\n,Name,Hip,Hip,Hip\n,ID,1,1,1\n,Parent,,,\n"
      ",,Position,Position,Position\nFrame,Time,X,Y,Z\n0,0,1,2,3\n";

  const Recording recording = read("a.csv", text);

  EXPECT_THAT(recording.columns, ElementsAre("Hip.x", "Hip.y", "Hip.z"));
  EXPECT_EQ(recording.unit, "mm");
  EXPECT_EQ(recording.frame_rate, 50);
}

// Motive 3 exports the time code, under which nothing stands.
TEST_F(TableHeads, OfMotiveMayHaveATimeCode) {
  const std::string text =
      "Format Version,1.24,Take Name,x,Export Frame Rate,120,Length Units,Centimeters\n\n"
      ",Type,,Marker,Marker,Marker\n,Name,,LED,LED,LED\n,ID,,\"4C\",\"4C\",\"4C\"\n"
      ",,,Position,Position,Position\nFrame,Time (Seconds),TimeCode,X,Y,Z\n"
      "0,0.000000,15:26:46:12.02,-92.5,311.25,134.125\n";

  const Recording recording = read("a.csv", text);

  EXPECT_THAT(recording.columns, ElementsAre("LED.x", "LED.y", "LED.z"));
  EXPECT_EQ(recording.unit, "cm");
  EXPECT_THAT(recording.notes.passed_through, ElementsAre("Frame", "Time (Seconds)", "TimeCode"));
  EXPECT_EQ(write("b.csv", recording), text);
}

TEST_F(TableHeads, OfMotiveHaveMeasuredMarkersBeforeExpectedOnes) {
  const std::string text =
      "Format Version,1.23,Export Frame Rate,50,Length Units,Meters\n\n"
      ",Type,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker,Marker,Marker,"
      "Marker\n,Name,R:M1,R:M1,R:M1,R:M1,R:M1,R:M1,R:M1\n,ID,1,1,1,1,2,2,2\n"
      ",,Position,Position,Position,Marker Quality,Position,Position,Position\n"
      "Frame,Time,X,Y,Z,,X,Y,Z\n0,0,1,2,3,1,4,5,6\n";

  EXPECT_EQ(read("a.csv", text).samples, (Matrix{{4, 5, 6}}));
  EXPECT_EQ(read("a.csv", replaced(text, "Marker,Marker,Marker\n", "Bone,Bone,Bone\n")).samples,
            (Matrix{{1, 2, 3}}));
}

TEST_F(TableHeads, OfMotiveThatBreakOffAreRefusedByLine) {
  expect_failure("a.csv", "Format Version,1.2,Export Frame Rate,fast\n",
                 "a.csv:1: expected a frame rate in Hz, found 'fast'");
  expect_failure("a.csv", "Format Version,1.2\n,Type,Marker\n",
                 "expected a line that begins with Frame, found the end of the file");
  expect_failure("a.csv", "Format Version,1.2\n,Type,A\n,,Rotation\nFrame,Time,X\n0,0,1\n",
                 "expected positions of markers, found none");
  expect_failure("a.csv", replaced(motive_csv, "4.1,5.1,6.1", "4.1,5.1"),
                 "a.csv:9: expected 19 columns, found 18");
}

const std::string nexus_csv =
    "Trajectories\n100\n,,Ann:LFHD,,,Ann:RFHD,,,Ann:LFHD,\n"
    "Frame,Sub Frame,X,Y,Z,X,Y,Z,X',Y'\n,,mm,mm,mm,mm,mm,mm,mm/s,mm/s\n"
    "11,0,1.5,2.5,3.5,,,,0,0\n12,0,1.6,2.6,3.6,4,5,6,0,0\n"
    "\nDevices\n1000\n,,Force.Fx\nFrame,Sub Frame,Fx\n,,N\n11,0,5\n11,1,6\n12,0,7\n"
    "\nEvents\n100\nSubject,Context,Name,Time (s),Description\nAnn,Left,Foot Strike,0.11,\n";

TEST_F(TableHeads, OfNexusHaveTheirTrajectoriesCleaned) {
  Recording recording = read("a.csv", nexus_csv);

  EXPECT_THAT(recording.columns, ElementsAre("Ann:LFHD.x", "Ann:LFHD.y", "Ann:LFHD.z", "Ann:RFHD.x",
                                             "Ann:RFHD.y", "Ann:RFHD.z"));
  EXPECT_TRUE(same_bits(recording.samples, Matrix{{1.5, 2.5, 3.5, test::nan, test::nan, test::nan},
                                                  {1.6, 2.6, 3.6, 4, 5, 6}}));
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_EQ(recording.unit, "mm");
  EXPECT_THAT(recording.notes.passed_through,
              ElementsAre("Frame", "Sub Frame", "Ann:LFHD X'", "Ann:LFHD Y'", "table devices",
                          "table events"));

  EXPECT_EQ(write("b.csv", recording), nexus_csv);
  recording.samples(0, 3) = 3.75;
  EXPECT_EQ(write("b.csv", recording), replaced(nexus_csv, "3.5,,,,0", "3.5,3.75,,,0"));
  EXPECT_EQ(write("b.csv", excerpt(read("a.csv", nexus_csv), 1, 2)),
            replaced(nexus_csv, "11,0,1.5,2.5,3.5,,,,0,0\n", ""));
}

TEST_F(TableHeads, OfNexusAreFoundBehindOtherTablesAndWithCommasAtTheEnds) {
  const std::string text =
      "Model Outputs,,,,\r\n100,,,,\r\n,,A:Angles,,\r\nFrame,Sub Frame,X,Y,Z\r\n,,deg,deg,deg\r\n"
      "1,0,9,9,9\r\n,,,,\r\nTrajectories,,,,\r\n100,,,,\r\n,,A:C7,,\r\nFrame,Sub Frame,X,Y,Z\r\n"
      ",,mm,mm,mm\r\n1,0,1,2,3\r\n,,,,\r\n";

  const Recording recording = read("a.csv", text);

  EXPECT_EQ(recording.samples, (Matrix{{1, 2, 3}}));
  EXPECT_EQ(write("b.csv", recording), text);
  EXPECT_EQ(write("b.txt", read("a.txt", text)), text);
}

// As Vicon Workstation exported them.
TEST_F(TableHeads, OfWorkstationHaveATitle) {
  const std::string text =
      "Title\nDate:\nTime:\nType:\nDescription:,\"\"\nNotes:,\"\"\n\nTRAJECTORIES\n100,Hz\n"
      ",LFHD,,,C7,,\nField #,X,Y,Z,X,Y,Z\n1,1.5,2,3,4,5,6\n2,1.6,2,3,,,\n";
  Recording recording = read("a.csv", text);

  EXPECT_THAT(recording.columns, ElementsAre("LFHD.x", "LFHD.y", "LFHD.z", "C7.x", "C7.y", "C7.z"));
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_EQ(recording.frames(), 2);
  EXPECT_EQ(write("b.csv", recording), text);
  recording.frame_rate = 50;
  EXPECT_EQ(write("b.csv", recording), replaced(text, "100,Hz", "50,Hz"));
}

TEST_F(TableHeads, OfNexusWithoutTrajectoriesAreRefused) {
  expect_failure("a.csv", "Devices\n1000\n,,F\nFrame,Sub Frame,Fx\n,,N\n1,0,5\n",
                 "expected a table Trajectories, found table devices");
  expect_failure("a.csv", replaced(nexus_csv, "Frame,Sub", "Item,Sub"),
                 "a.csv:4: expected Frame, Sub Frame, X, Y, Z ...");
  expect_failure("a.csv", replaced(nexus_csv, "12,0,1.6,", "12,0,one,"),
                 "a.csv:7: expected a number, found 'one' in column 3 ('Ann:LFHD X')");
}

const std::string qtm_head =
    "NO_OF_FRAMES\t2\nNO_OF_CAMERAS\t8\nNO_OF_MARKERS\t2\nFREQUENCY\t100\nNO_OF_ANALOG\t0\n"
    "ANALOG_FREQUENCY\t0\nDESCRIPTION\t--\nTIME_STAMP\t2021-01-01, 10:00:00\nDATA_INCLUDED\t3D\n"
    "MARKER_NAMES\tL heel\tR heel\nTRAJECTORY_TYPES\tMeasured\tMixed\n";

TEST_F(TableHeads, OfQtmAreReadWithAndWithoutFrameTimeAndNames) {
  const std::string rows = "1.5\t2\t3\t4\t5\t6\n7\t8\t9\t\t\t\n";
  const std::string timed = "1\t0.00\t1.5\t2\t3\t4\t5\t6\n2\t0.01\t7\t8\t9\t\t\t\n";
  const std::string names = "L heel X\tL heel Y\tL heel Z\tR heel X\tR heel Y\tR heel Z\n";

  for (const std::string& text : {qtm_head + rows, qtm_head + timed, qtm_head + names + rows,
                                  qtm_head + "Frame\tTime\t" + names + timed}) {
    for (const char* name : {"a.tsv", "a.csv", "a.txt"}) {
      const Recording recording = read(name, text);
      EXPECT_THAT(recording.columns, ElementsAre("L heel.x", "L heel.y", "L heel.z", "R heel.x",
                                                 "R heel.y", "R heel.z"));
      EXPECT_TRUE(same_bits(recording.samples, Matrix{{1.5, 2, 3, 4, 5, 6},
                                                      {7, 8, 9, test::nan, test::nan, test::nan}}));
      EXPECT_EQ(recording.frame_rate, 100);
      EXPECT_EQ(recording.unit, "mm");
      EXPECT_EQ(write(name, recording), text);
    }
  }
}

TEST_F(TableHeads, OfQtmMayHoldEvents) {
  const std::string text =
      replaced(qtm_head, "MARKER_NAMES", "EVENT\tkick\t2\t0.01\nMARKER_NAMES") +
      "1\t2\t3\t4\t5\t6\n";

  const Recording recording = read("a.tsv", text);

  EXPECT_EQ(recording.samples, (Matrix{{1, 2, 3, 4, 5, 6}}));
  EXPECT_EQ(write("a.tsv", recording), text);
}

TEST_F(TableHeads, OfQtmSayAnotherCountAndRate) {
  Recording recording = read("a.tsv", qtm_head + "1\t2\t3\t4\t5\t6\n1\t2\t3\t4\t5\t6.0\n");
  recording = excerpt(recording, 1, 2);
  recording.frame_rate = 50;

  EXPECT_EQ(write("b.tsv", recording),
            replaced(replaced(qtm_head, "FRAMES\t2", "FRAMES\t1"), "Y\t100", "Y\t50") +
                "1\t2\t3\t4\t5\t6.0\n");
}

// Angles and the like that QTM calculates from markers: channels under a line of names.
TEST_F(TableHeads, OfQtmMayHoldResultsOfCalculations) {
  const std::string text =
      "NO_OF_FRAMES\t2\r\nNO_OF_DATA_TYPES\t1\r\nFREQUENCY\t100\r\nDATA_INCLUDED\tAngle\r\n"
      "DATA_TYPES\tleft_q1\r\n\r\nFrame\tTime\tleft_q1_XY\t\r\n1\t0.00000\t79.301\r\n"
      "2\t0.01000\t79.305\r\n";

  const Recording recording = read("a.tsv", text);

  EXPECT_THAT(recording.columns, ElementsAre("left_q1_XY"));
  EXPECT_EQ(recording.samples, (Matrix{{79.301}, {79.305}}));
  EXPECT_EQ(recording.unit, "");
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_EQ(write("b.tsv", recording), text);
}

TEST_F(TableHeads, OfQtmThatHoldNoMarkersAreRefused) {
  expect_failure("a.tsv", replaced(qtm_head, "D\t3D", "D\t6D") + "1\t2\t3\t4\t5\t6\n",
                 "a.tsv:9: expected positions of markers (DATA_INCLUDED 3D), found '6D'");
  expect_failure("a.tsv", "NO_OF_FRAMES\t1\nFREQUENCY\t100\n1\t2\t3\n",
                 "a.tsv:3: expected MARKER_NAMES above the rows, found none");
  expect_failure("a.tsv", qtm_head, "expected rows of samples, found the end of the file");
  expect_failure("a.tsv", qtm_head + "1\t2\t3\t4\t5\n", "a.tsv:12: expected 6 columns, found 5");
}

TEST_F(TableHeads, OfDeepLabCutAreReadWithOneAndSeveralAnimals) {
  const std::string one =
      "scorer,net,net,net,net,net,net\nbodyparts,nose,nose,nose,tail,tail,tail\n"
      "coords,x,y,likelihood,x,y,likelihood\n0,1.5,2,0.9,3,4,0\n1,1.6,2,0.9,3,4,0.5\n";
  const std::string two =
      "scorer,net,net,net,net,net,net\nindividuals,m1,m1,m1,m2,m2,m2\n"
      "bodyparts,nose,nose,nose,nose,nose,nose\ncoords,x,y,likelihood,x,y,likelihood\n"
      "img1.png,1.5,2,0.9,,,\nimg2.png,1.6,2,0.9,3,4,0.5\n";

  const Recording mouse = read("a.csv", one), mice = read("b.csv", two);

  EXPECT_THAT(mouse.columns, ElementsAre("nose.x", "nose.y", "tail.x", "tail.y"));
  EXPECT_TRUE(same_bits(mouse.samples, Matrix{{1.5, 2, test::nan, test::nan}, {1.6, 2, 3, 4}}));
  EXPECT_EQ(write("a.csv", mouse), one);
  EXPECT_THAT(mice.columns, ElementsAre("m1:nose.x", "m1:nose.y", "m2:nose.x", "m2:nose.y"));
  EXPECT_EQ(write("b.csv", mice), two);
}

TEST_F(TableHeads, OfDeepLabCutInSpaceAndBrokenOnes) {
  const std::string three =
      "scorer,net,net,net\nbodyparts,nose,nose,nose\ncoords,x,y,z\n0,1,2,3\n1,1,2,3\n";

  EXPECT_THAT(read("a.csv", three).columns, ElementsAre("nose.x", "nose.y", "nose.z"));
  expect_failure("a.csv", "scorer,net,net\nbodyparts,a,a\n0,1,2\n",
                 "expected lines bodyparts and coords with a cell per column");
}

TEST_F(TableHeads, OfAniposeAndMediaPipeAreNames) {
  const std::string anipose =
      "nose_x,nose_y,nose_z,nose_error,nose_ncams,nose_score,M_00,M_01,center_0,fnum\n"
      "1,2,3,0.5,2,0.9,1,0,0,0\n,,,,0,0,1,0,0,1\n";
  const std::string mediapipe =
      "frame,timestamp_ms,LEFT_HIP_x,LEFT_HIP_y,LEFT_HIP_z,LEFT_HIP_visibility\n"
      "0,0,0.1,0.2,0.3,0.99\n1,33,0.1,0.2,0.3,0.99\n2,67,0.1,0.2,0.3,0.99\n";

  EXPECT_THAT(read("a.csv", anipose).columns, ElementsAre("nose.x", "nose.y", "nose.z"));
  EXPECT_EQ(write("b.csv", read("a.csv", anipose)), anipose);
  EXPECT_THAT(read("a.csv", mediapipe).columns,
              ElementsAre("LEFT_HIP.x", "LEFT_HIP.y", "LEFT_HIP.z"));
  EXPECT_NEAR(read("a.csv", mediapipe).frame_rate, 30, 0.2);
}

}  // namespace
}  // namespace moclean
