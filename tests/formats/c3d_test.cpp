#include "moclean/formats/c3d.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "formats/c3d_maker.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::C3dMaker;
using test::same_bits;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;
using namespace std::string_literals;

constexpr double gap = test::nan;

Recording read(const C3dMaker& maker) { return parse_c3d(maker.bytes(), "x.c3d"); }

void expect_refused(const std::string& bytes, const std::string& message) {
  EXPECT_THAT([&] { parse_c3d(bytes, "x.c3d"); }, ThrowsMessage<FileError>(HasSubstr(message)));
}

class C3dProcessors : public testing::TestWithParam<int> {};

TEST_P(C3dProcessors, ReadsReals) {
  const Recording take = read({.processor = GetParam()});

  EXPECT_TRUE(same_bits(take.samples, Matrix{{1, 2, 3, 4, 5, 6}, {7, 8, 9, gap, gap, gap}}));
  EXPECT_THAT(take.columns, ElementsAre("hip.x", "hip.y", "hip.z", "knee.x", "knee.y", "knee.z"));
  EXPECT_EQ(take.frame_rate, 120);
  EXPECT_EQ(take.unit, "mm");
}

TEST_P(C3dProcessors, ReadsScaledIntegers) {
  const Recording take = read({.processor = GetParam(), .scale = 0.5});

  EXPECT_TRUE(
      same_bits(take.samples, Matrix{{.5, 1, 1.5, 2, 2.5, 3}, {3.5, 4, 4.5, gap, gap, gap}}));
}

TEST_P(C3dProcessors, PassesOverAnalogSamples) {
  const Recording take = read({.processor = GetParam(),
                               .frames = {{1, 2, 3, 0, 77, 78}, {4, 5, 6, 0, 79, 80}},
                               .points = 1});

  EXPECT_TRUE(same_bits(take.samples, Matrix{{1, 2, 3}, {4, 5, 6}}));
}

INSTANTIATE_TEST_SUITE_P(All, C3dProcessors, testing::Values(84, 85, 86));

TEST(C3dReading, TakesAnyWordWithItsSignBitForInvalid) {
  const Recording take =
      read({.frames = {{1, 2, 3, 65535, 4, 5, 6, -32768}, {1, 2, 3, 32767, 4, 5, 6, 0}}});

  EXPECT_TRUE(same_bits(take.samples, Matrix{{gap, gap, gap, gap, gap, gap}, {1, 2, 3, 4, 5, 6}}));
}

TEST(C3dReading, TakesTheOriginForMissingOnlyOfPointsThatAreElsewhere) {
  const Recording take = read({.frames = {{0, 0, 0, 0, 0, 0, 0, 0}, {7, 8, 9, 0, 0, 0, 0, 0}}});

  EXPECT_TRUE(same_bits(take.samples, Matrix{{gap, gap, gap, 0, 0, 0}, {7, 8, 9, 0, 0, 0}}));
}

TEST(C3dReading, KeepsAMeasuredPointAtTheOrigin) {
  const Recording take = read({.frames = {{0, 0, 0, 256, 1, 1, 1, 0}, {7, 8, 9, 0, 1, 1, 1, 0}}});

  EXPECT_TRUE(same_bits(take.samples, Matrix{{0, 0, 0, 1, 1, 1}, {7, 8, 9, 1, 1, 1}}));
}

TEST(C3dReading, NamesPointsWithoutLabelAndThoseOfOneLabel) {
  const C3dMaker maker{
      .labels = {"a", "", "a", "a_2"}, .frames = {std::vector<double>(20, 1.0)}, .points = 5};

  const std::vector<Joint> all = joints(read(maker));

  std::vector<std::string> names;
  for (const Joint& joint : all) names.push_back(joint.name);
  EXPECT_THAT(names, ElementsAre("a", "point2", "a_3", "a_2", "point5"));
}

TEST(C3dReading, LeavesResultsOfAModelOut) {
  C3dMaker maker{.labels = {"hip", "HipAngles"}};
  maker.parameters = maker.texts(1, "ANGLES", {"HipAngles"});

  EXPECT_THAT(read(maker).columns, ElementsAre("hip.x", "hip.y", "hip.z"));

  maker.labels = {"HipAngles", "HipAngles"};
  expect_refused(maker.bytes(), "holds no coordinates, only results of a model");
}

TEST(C3dReading, FindsMoreLabelsInLabels2) {
  C3dMaker maker{.labels = {"hip"}};
  maker.parameters = maker.texts(1, "LABELS2", {"foot"});

  EXPECT_EQ(read(maker).columns[3], "foot.x");
}

TEST(C3dReading, TakesTheUpwardAxisFromTheScreen) {
  C3dMaker maker;
  for (const auto& [axis, up] :
       {std::pair("+X", UpAxis::x), {"+Y", UpAxis::y}, {"-Z", UpAxis::z}}) {
    maker.parameters = maker.text(1, "Y_SCREEN", axis);
    EXPECT_EQ(read(maker).up, up);
  }
  maker.parameters = maker.text(1, "Y_SCREEN", "up");
  EXPECT_EQ(read(maker).up, std::nullopt);
}

TEST(C3dReading, TakesTheCountOfFramesThatFillsTheFile) {
  C3dMaker maker{.frames = std::vector(70000, std::vector<double>{1, 2, 3, 0}),
                 .points = 1,
                 .header_last = 65535,
                 .stated_frames = 65535};
  maker.parameters =
      maker.group(2, "TRIAL") +
      maker.parameter(2, "ACTUAL_START_FIELD", 2, {2}, maker.word(1) + maker.word(0)) +
      maker.parameter(2, "ACTUAL_END_FIELD", 2, {2}, maker.word(70000 & 0xFFFF) + maker.word(1));
  EXPECT_EQ(read(maker).frames(), 70000);

  maker.parameters = maker.parameter(1, "LONG_FRAMES", 4, {}, maker.real(70000));
  EXPECT_EQ(read(maker).frames(), 70000);

  maker.parameters.clear();
  maker.frames.resize(65535);
  EXPECT_EQ(read(maker).frames(), 65535);
}

TEST(C3dReading, FindsTheParametersAnywhere) {
  const Matrix expected{{1, 2, 3, 4, 5, 6}, {7, 8, 9, gap, gap, gap}};

  EXPECT_TRUE(same_bits(read({.parameter_block = 5}).samples, expected));
  EXPECT_TRUE(same_bits(read({.parameter_block = 3, .data_block = 2}).samples, expected));
}

TEST(C3dReading, FindsTheDataBehindTheParametersIfNothingSaysWhere) {
  std::string bytes = C3dMaker{.data_block = 3}.bytes();
  bytes.replace(16, 2, 2, '\0');
  bytes.replace(bytes.find("DATA_START") + 14, 2, 2, '\0');

  EXPECT_EQ(parse_c3d(bytes, "x.c3d").samples(1, 2), 9);
}

TEST(C3dReading, ReadsParametersUpToOneWithoutOffset) {
  const C3dMaker maker{.ending = "\x01\x01Z\0\0\x02\0\x05\0\0"s};

  EXPECT_EQ(read(maker).frames(), 2);
}

TEST(C3dReading, RefusesWhatIsNoC3dFile) {
  expect_refused("", "expected a C3D file, which begins with a header of 512 bytes, found 0 bytes");
  expect_refused(std::string(600, 'x'), "byte 1: expected 80, as in every C3D file, found 120");
  expect_refused(C3dMaker{.processor = 83}.bytes(), "byte 515: expected the processor");
  expect_refused(C3dMaker{}.bytes().substr(0, 512), "byte 0: expected the block in which");
}

TEST(C3dReading, RefusesTooFewFramesNamingBothCounts) {
  C3dMaker maker{.header_last = 9, .stated_frames = 9};

  expect_refused(maker.bytes().substr(0, 1024 + 40),
                 "the C3D data are cut short: expected 9 frames of 32 bytes (POINT:FRAMES) from "
                 "byte 1024, found 40 bytes, which are 1 whole frames");
}

TEST(C3dReading, RefusesFilesWithoutPointsOrFrames) {
  expect_refused(C3dMaker{.frames = {{1, 2}}, .points = 0}.bytes(),
                 "holds no 3-D points, only 2 analog samples per frame");
  C3dMaker none{.first_frame = 2, .header_last = 1, .stated_frames = 0};
  expect_refused(none.bytes(), "states no number of frames above 0");
}

TEST(C3dReading, RefusesInfiniteCoordinatesAndScales) {
  expect_refused(C3dMaker{.frames = {{1, 2, 1e300, 0, 1, 1, 1, 1}}}.bytes(),
                 "byte 1024: expected finite coordinates of point 1 in frame 0, found inf");
  expect_refused(C3dMaker{.scale = 0}.bytes(), "expected POINT:SCALE");
}

TEST(C3dReading, RefusesParametersBeyondTheFile) {
  expect_refused(C3dMaker{.ending = "\x01\x01Z\xFF\x7F"}.bytes(),
                 "expected one after 'Z' of the C3D parameters, found the end of the file");
}

}  // namespace
}  // namespace moclean
