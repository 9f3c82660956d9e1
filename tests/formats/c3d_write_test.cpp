#include <string>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/core/version.hpp"
#include "moclean/formats/c3d.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/motion/framed_source.hpp"

#include "formats/c3d_maker.hpp"
#include "formats/temporary_folder.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::C3dMaker;
using test::same_bits;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double gap = test::nan;

class C3dWriting : public testing::Test {
 protected:
  std::string written(const Recording& recording) {
    write_recording(folder_.path() / "out.c3d", recording);
    return read_file(folder_.path() / "out.c3d");
  }

  test::TemporaryFolder folder_;
};

Recording read(const std::string& bytes) { return parse_c3d(bytes, "x.c3d"); }

C3dParameters parameters_of(const std::string& bytes) {
  return parse_c3d_file(bytes, "x.c3d").parameters;
}

// Analog samples of reals, as stored.
double real_at(const std::string& bytes, std::size_t at) {
  return C3dNumbers(C3dProcessor::intel).real(&bytes[at]);
}

const C3dMaker with_analog{.frames = {{1, 2, 3, 5, 4, 5, 6, 257, 70},
                                      {7, 8, 9, 5, 0, 0, 0, -1, 71},
                                      {1, 1, 1, 5, 0, 0, 0, -1, 72}}};

TEST_F(C3dWriting, KeepsEveryByteOfWhatWasNotChanged) {
  for (const int processor : {84, 85, 86})
    for (const double scale : {-1.0, 0.5})
      for (const int block : {2, 4}) {
        const std::string bytes = C3dMaker{.processor = processor,
                                           .scale = scale,
                                           .frames = with_analog.frames,
                                           .parameter_block = block}
                                      .bytes();
        EXPECT_TRUE(written(read(bytes)) == bytes) << processor << " " << scale << " " << block;
      }
  const std::string behind = C3dMaker{.parameter_block = 3, .data_block = 2}.bytes() + "tail";
  EXPECT_TRUE(written(read(behind)) == behind);
}

TEST_F(C3dWriting, MarksFilledAndCorrectedSamplesAndKeepsGaps) {
  const std::string bytes = with_analog.bytes();
  Recording take = read(bytes);
  take.samples(0, 0) = 1.5;                              // corrected
  take.samples.row(1).tail<3>() << 4, 5.5, 6;            // filled
  take.samples.row(2).head<3>().setConstant(test::nan);  // removed

  const std::string result = written(take);

  EXPECT_TRUE(same_bits(read(result).samples, take.samples));
  const std::size_t start = 1024, frame = 36;
  ASSERT_EQ(result.size(), bytes.size());
  EXPECT_EQ(real_at(result, start + 12), 0);               // the corrected one's word
  EXPECT_EQ(real_at(result, start + 16 + 12), 257);        // untouched
  EXPECT_EQ(real_at(result, start + frame + 16 + 12), 0);  // filled
  EXPECT_EQ(real_at(result, start + 2 * frame + 12), -1);  // removed
  EXPECT_EQ(real_at(result, start + 2 * frame), 0);
  EXPECT_EQ(real_at(result, start + 2 * frame + 28), -1);  // still a gap
  for (const std::size_t f : {0U, 1U, 2U})
    EXPECT_EQ(real_at(result, start + f * frame + 32), 70.0 + static_cast<double>(f));
  const C3dParameters parameters = parameters_of(result);
  EXPECT_THAT(parameters.numbers("moclean", "filled"), ElementsAre(0, 1));
  EXPECT_THAT(parameters.numbers("MOCLEAN", "CORRECTED"), ElementsAre(1, 0));
  EXPECT_THAT(parameters.numbers("MOCLEAN", "REMOVED"), ElementsAre(1, 0));
  EXPECT_EQ(parameters.text("MOCLEAN", "VERSION"), version());
}

TEST_F(C3dWriting, KeepsTheGroupsBeforeItsOwnInPlace) {
  const std::string bytes = with_analog.bytes();
  Recording take = read(bytes);
  take.samples(0, 0) = 1.5;

  const std::string once = written(take);
  Recording again = read(once);
  again.samples(0, 0) = 2.5;
  const std::string twice = written(again);

  const std::size_t own = once.find("MOCLEAN") - 2;
  EXPECT_EQ(once.substr(0, own), bytes.substr(0, own));
  EXPECT_EQ(twice.size(), once.size());
  EXPECT_EQ(twice.find("MOCLEAN", own + 10), std::string::npos);
}

TEST_F(C3dWriting, MovesTheDataWhereTheParametersOutgrowTheirBlocks) {
  for (const int processor : {84, 85, 86}) {
    C3dMaker maker{.processor = processor, .frames = with_analog.frames};
    maker.parameters = maker.text(1, "FILLER", std::string(255, 'f'));
    Recording take = read(maker.bytes());
    take.samples(0, 0) = 1.5;

    const std::string result = written(take);

    EXPECT_EQ(result.size(), maker.bytes().size() + 512);
    EXPECT_EQ(result.substr(1536), written(take).substr(1536));
    EXPECT_EQ(parse_c3d_file(result, "x.c3d").layout.data_start, 1536u);
    EXPECT_THAT(parameters_of(result).numbers("POINT", "DATA_START"), ElementsAre(4));
    EXPECT_EQ(result[512 + 2], 2);
    EXPECT_TRUE(same_bits(read(result).samples, take.samples));
  }
}

TEST_F(C3dWriting, MovesParametersBehindTheDataBeforeThem) {
  Recording take = read(C3dMaker{.parameter_block = 3, .data_block = 2}.bytes());
  take.samples(0, 0) = 1.5;

  EXPECT_TRUE(same_bits(read(written(take)).samples, take.samples));
}

TEST_F(C3dWriting, RoundsToTheScaleOfIntegers) {
  Recording take = read(C3dMaker{.scale = 0.5}.bytes());
  take.samples(0, 0) = 1.74;
  take.samples(0, 1) += 0.1;  // less than half a unit: stays, with its word

  const Recording back = read(written(take));

  EXPECT_EQ(back.samples(0, 0), 1.5);
  EXPECT_EQ(back.samples(0, 1), 1);
}

TEST_F(C3dWriting, ChangesOfLessThanHalfAUnitAreNone) {
  const std::string bytes = C3dMaker{.scale = 0.5}.bytes();
  Recording take = read(bytes);
  take.samples(0, 1) += 0.1;

  EXPECT_TRUE(written(take) == bytes);
}

TEST_F(C3dWriting, StoresRealsWhereAnIntegerDoesNotFit) {
  for (const int processor : {84, 85, 86}) {
    C3dMaker maker{.processor = processor, .scale = 0.5, .frames = with_analog.frames};
    maker.parameters = maker.group(2, "ANALOG") + maker.text(2, "FORMAT", "UNSIGNED");
    maker.frames[0][8] = 65000;
    Recording take = read(maker.bytes());
    take.samples(0, 0) = 20000.25;

    const std::string result = written(take);

    const C3dFile c3d = parse_c3d_file(result, "x.c3d");
    EXPECT_TRUE(c3d.layout.is_float);
    EXPECT_THAT(c3d.parameters.numbers("POINT", "SCALE"), ElementsAre(-0.5));
    EXPECT_TRUE(same_bits(read(result).samples, take.samples));
    const auto real = [&](std::size_t at) {
      return c3d.layout.numbers.real(&result[c3d.layout.data_start + at]);
    };
    EXPECT_EQ(real(12), 0);
    EXPECT_EQ(real(28), 257);
    EXPECT_EQ(real(32), 65000);
    EXPECT_EQ(real(68), 71);
    EXPECT_THAT(c3d.parameters.numbers("MOCLEAN", "CORRECTED"), ElementsAre(1, 0));
  }
}

// 0, 0, 0 without residual is missing if the point is elsewhere in other frames.
TEST_F(C3dWriting, KeepsAPointAtTheOriginWhereItsOtherFramesChange) {
  for (const int processor : {84, 85, 86})
    for (const double scale : {-1.0, 0.5}) {
      SCOPED_TRACE(fmt::format("processor {}, scale {}", processor, scale));
      const std::vector<double> frame = {0, 0, 0, 0, 4, 5, 6, 0};
      Recording take =
          read(C3dMaker{.processor = processor, .scale = scale, .frames = {frame, frame}}.bytes());
      take.samples(0, 0) = 1;      // is elsewhere now
      take.samples.row(1) *= 0.0;  // the other point comes there

      EXPECT_TRUE(same_bits(read(written(take)).samples, take.samples));
    }
}

TEST_F(C3dWriting, KeepsAMissingPointMissingInAPartWhereItIsAtTheOrigin) {
  for (const double scale : {-1.0, 0.5}) {
    const Recording take = read(
        C3dMaker{.scale = scale, .frames = {{0, 0, 0, 0, 4, 5, 6, 0}, {7, 8, 9, 0, 4, 5, 6, 0}}}
            .bytes());

    const Matrix back = read(written(excerpt(take, 0, 1))).samples;

    EXPECT_TRUE(same_bits(
        back, Matrix{{gap, gap, gap, take.samples(0, 3), take.samples(0, 4), take.samples(0, 5)}}));
  }
}

TEST_F(C3dWriting, NumbersThePartOfATrial) {
  C3dMaker maker{.frames = with_analog.frames, .first_frame = 65530};
  maker.parameters =
      maker.parameter(1, "LONG_FRAMES", 4, {}, maker.real(3)) + maker.group(2, "TRIAL") +
      maker.parameter(2, "ACTUAL_START_FIELD", 2, {2}, maker.word(65535) + maker.word(0)) +
      maker.parameter(2, "ACTUAL_END_FIELD", 2, {2}, maker.word(1) + maker.word(1));
  const Recording take = read(maker.bytes());

  const std::string result = written(excerpt(excerpt(take, 1, 3), 0, 2));

  EXPECT_TRUE(same_bits(read(result).samples, Matrix(take.samples.bottomRows(2))));
  const C3dFile c3d = parse_c3d_file(result, "x.c3d");
  EXPECT_EQ(c3d.layout.first_frame, 65536);
  EXPECT_EQ(c3d.layout.frames, 2);
  EXPECT_THAT(c3d.parameters.words("TRIAL", "ACTUAL_END_FIELD"), ElementsAre(1, 1));
  EXPECT_THAT(c3d.parameters.numbers("POINT", "FRAMES"), ElementsAre(2));
  EXPECT_THAT(c3d.parameters.numbers("POINT", "LONG_FRAMES"), ElementsAre(2));
  EXPECT_EQ(real_at(result, c3d.layout.data_start + 32), 71);
  EXPECT_FALSE(c3d.parameters.has_group("MOCLEAN"));
}

TEST_F(C3dWriting, CountsThePartAlsoWhereTheCountIsAByte) {
  C3dMaker maker{.frames = with_analog.frames};
  maker.parameters = maker.parameter(1, "LONG_FRAMES", 1, {}, "\x03");
  const Recording take = read(maker.bytes());

  const Recording back = read(written(excerpt(take, 1, 3)));

  EXPECT_TRUE(same_bits(back.samples, Matrix(take.samples.bottomRows(2))));
}

TEST_F(C3dWriting, HasNoSourceForThinnedFramesOrOtherColumns) {
  const Recording take = read(with_analog.bytes());

  EXPECT_EQ(parse_c3d_file(written(thinned(take, 2)), "x.c3d").layout.analog, 0);
  EXPECT_EQ(parse_c3d_file(written(columns_of(take, {0, 1, 2})), "x.c3d").layout.points, 1);
}

Recording walk(Index frames, Index points) {
  Recording take{
      .samples = (1000 * test::random_matrix(frames, 3 * points, 1)).cast<float>().cast<double>(),
      .columns = {},
      .frame_rate = 59.94,
      .unit = "cm",
      .up = UpAxis::y};
  for (Index p = 0; p < points; ++p)
    for (const char* axis : {".x", ".y", ".z"})
      take.columns.push_back("marker " + std::to_string(p) + axis);
  return take;
}

TEST_F(C3dWriting, MakesNewFilesOfAnySize) {
  for (const auto& [frames, points] : {std::pair<Index, Index>(3, 1), {2, 700}, {70000, 1}}) {
    Recording take = walk(frames, points);
    take.samples.row(1).head<3>().setConstant(gap);
    take.samples.row(0).head<3>().setZero();

    const Recording back = read(written(take));

    EXPECT_TRUE(same_bits(back.samples, take.samples));
    EXPECT_EQ(back.columns, take.columns);
    EXPECT_EQ(back.frame_rate, take.frame_rate);
    EXPECT_EQ(back.unit, take.unit);
    EXPECT_EQ(back.up, take.up);
  }
}

TEST_F(C3dWriting, RefusesWhatANewFileCannotHold) {
  Recording take = walk(1, 1);
  take.samples(0, 0) = 1e39;
  EXPECT_THAT([&] { written(take); }, ThrowsMessage<FileError>(HasSubstr("no room for the coord")));

  take.columns[0] = "time";
  EXPECT_THAT([&] { written(take); },
              ThrowsMessage<FileError>(HasSubstr("column 'time' is no coordinate")));

  take.columns = {std::string(256, 'n') + ".x", std::string(256, 'n') + ".y",
                  std::string(256, 'n') + ".z"};
  EXPECT_THAT([&] { written(take); }, ThrowsMessage<FileError>(HasSubstr("names of 255 bytes")));
}

}  // namespace
}  // namespace moclean
