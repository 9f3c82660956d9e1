// Storage and motion files of OpenSim: small ones as its versions write them.
#include <gmock/gmock.h>

#include "formats/named_tables.hpp"
#include "formats/tiny_files.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::replaced;
using test::same_bits;
using testing::ElementsAre;
using testing::HasSubstr;

class Storages : public test::NamedTables {};

TEST_F(Storages, OfOpenSimHaveChannels) {
  const std::string text(test::tiny_mot);
  Recording recording = read("a.mot", text);

  EXPECT_THAT(recording.columns, ElementsAre("hip_flexion", "knee_angle"));
  EXPECT_TRUE(same_bits(recording.samples, Matrix{{10.5, 20}, {11.5, test::nan}, {12.5, 24}}));
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_THAT(recording.notes.layout, HasSubstr("OpenSim storage, angles in degrees: 2 channels"));
  EXPECT_EQ(write("b.mot", recording), text);
  recording.samples(1, 1) = 22;
  EXPECT_EQ(write("b.mot", recording), replaced(text, "nan", "22"));
  EXPECT_EQ(write("b.mot", excerpt(recording, 0, 1)),
            replaced(text.substr(0, text.find("0.01")), "nRows=3", "nRows=1"));
}

TEST_F(Storages, OfOlderOpenSimHaveBlanksForTabs) {
  const std::string text =
      "name old.mot\ndatacolumns 4\ndatarows 2\nrange 0 0.1\nendheader\n"
      "   time  ground_force_vx  ground_force_px   torque_y\n"
      "   0.00\t  1.5   2  3\n   0.10\t  4     5  6\n";

  const Recording recording = read("a.mot", text);

  EXPECT_EQ(recording.samples, (Matrix{{1.5, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(recording.frame_rate, 10);
  EXPECT_EQ(write("b.mot", recording), text);
}

TEST_F(Storages, OfOpenSimMayHaveGoneThroughASpreadsheet) {
  const std::string text =
      "Coordinates,,,\nnRows=2,,,\ninDegrees=yes,,,\n,,,\nendheader,,,\n"
      "time,thorax_tilt,thorax_tx,elbow\n0,1.5,2,3\n0.01,1.6,2,3\n";
  const Recording recording = read("a.mot", text);

  EXPECT_THAT(recording.columns, ElementsAre("thorax_tilt", "thorax_tx", "elbow"));
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_EQ(write("b.mot", recording), text);
  EXPECT_EQ(write("b.mot", excerpt(recording, 0, 1)),
            replaced(replaced(text, "nRows=2", "nRows=1"), "0.01,1.6,2,3\n", ""));
}

// Found by fuzzing: the place of a count that is not there was none in the file.
TEST_F(Storages, WithoutACountGetOneWhereItWouldStand) {
  const std::string text =
      "Coordinates\nnRows=\ninDegrees=yes\nendheader\ntime\telbow\n0\t1.5\n0.01\t1.6\n";
  const Recording recording = read("a.mot", text);

  EXPECT_EQ(write("b.mot", recording), text);
  EXPECT_EQ(write("b.mot", excerpt(recording, 0, 1)),
            replaced(replaced(text, "nRows=", "nRows=1"), "0.01\t1.6\n", ""));
}

// One point among joint angles is no reason to leave these out.
TEST_F(Storages, OfOpenSimHaveChannelsWhereMostAreNoPoints) {
  const std::string head = "x\nendheader\n";

  EXPECT_THAT(
      read("a.mot", head + "time\thip\tknee\tankle\tbox_transX\tbox_transY\tbox_transZ\tlist\n"
                           "0\t1\t2\t3\t4\t5\t6\t7\n")
          .columns,
      ElementsAre("hip", "knee", "ankle", "box_transX", "box_transY", "box_transZ", "list"));
  EXPECT_THAT(read("a.sto", head + "time\ta_x\ta_y\ta_z\n0\t1\t2\t3\n").columns,
              ElementsAre("a.x", "a.y", "a.z"));
}

const std::string marker_sto =
    "DataRate=100.000000\nDataType=Vec3\nUnits=mm\nversion=3\nOpenSimVersion=4.1\nendheader\n"
    "time\tL.ASIS\tC7\n0\t1.5,2,3\t-4,5,6e2\n0.01\t1.6,2,3\tnan,nan,nan\n";

TEST_F(Storages, OfOpenSimMayHaveAVectorInACell) {
  Recording recording = read("a.sto", marker_sto);

  EXPECT_THAT(recording.columns,
              ElementsAre("L.ASIS.x", "L.ASIS.y", "L.ASIS.z", "C7.x", "C7.y", "C7.z"));
  EXPECT_TRUE(same_bits(recording.samples, Matrix{{1.5, 2, 3, -4, 5, 600},
                                                  {1.6, 2, 3, test::nan, test::nan, test::nan}}));
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_EQ(recording.unit, "mm");

  EXPECT_EQ(write("b.sto", recording), marker_sto);
  recording.samples.row(1) << 1.6, test::nan, 3, 7, 8.25, 9;
  EXPECT_EQ(write("b.sto", recording),
            replaced(marker_sto, "1.6,2,3\tnan,nan,nan", "1.6,nan,3\t7,8.25,9"));
}

TEST_F(Storages, OfOpenSimWithVectorsAreRefusedByLine) {
  EXPECT_EQ(read("a.sto", "DataType=Vec3\nendheader\ntime\ta\n0\t1:2:3\n").samples,
            (Matrix{{1, 2, 3}}));
  expect_failure("a.sto", replaced(marker_sto, "nan,nan,nan", "nan,nan"),
                 "a.sto:9: expected 7 columns, found 6");
  expect_failure("a.sto", replaced(marker_sto, "-4,5", "-4,five"),
                 "a.sto:8: expected a number, found 'five' in column 6 ('C7.y')");
  expect_failure("a.sto", "DataType=Vec3\nendheader\ntime\n0\n",
                 "expected names of markers behind time, found none");
}

TEST_F(Storages, OfOpenSimThatHoldNoNumbersAreRefused) {
  expect_failure("a.sto", "x\nDataType=Quaternion\nendheader\ntime\ta\n0\t1,0,0,0\n",
                 "a.sto:2: expected DataType=double or Vec3, found 'Quaternion'");
  expect_failure("a.sto", "time\ta\n0\t1\n",
                 "expected a head that ends with a line endheader, found none");
  expect_failure("a.mot", "x\nendheader\n", "expected a line of column names, found the end");
}

}  // namespace
}  // namespace moclean
