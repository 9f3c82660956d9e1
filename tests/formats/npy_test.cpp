#include "moclean/formats/npy.hpp"

#include <cstdint>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/npy_maker.hpp"
#include "formats/temporary_folder.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

using test::bytes;
using test::dictionary;
using test::npy;

Recording read(const std::string& file, const ReadOptions& options = {}) {
  return parse_npy(file, "x.npy", options);
}

const Matrix two_by_three{{1, 2, 3}, {4, 5, 6.5}};

TEST(Npy, ReadsEveryTypeAndByteOrder) {
  const std::initializer_list<double> c_order = {1, 2, 3, 4, 5, 6.5};

  EXPECT_EQ(read(npy(dictionary("<f8", false, "(2, 3)"), bytes<double>(c_order))).samples,
            two_by_three);
  EXPECT_EQ(read(npy(dictionary(">f8", false, "(2, 3)"), bytes<double>(c_order, true))).samples,
            two_by_three);
  EXPECT_EQ(read(npy(dictionary("<f4", false, "(2, 3)"), bytes<float>(c_order))).samples,
            two_by_three);
  EXPECT_EQ(read(npy(dictionary(">f4", false, "(2, 3)"), bytes<float>(c_order, true))).samples,
            two_by_three);
}

TEST(Npy, ReadsFortranOrder) {
  const std::string file =
      npy(dictionary("<f4", true, "(2, 3)"), bytes<float>({1, 4, 2, 5, 3, 6.5}));

  EXPECT_EQ(read(file).samples, two_by_three);
}

TEST(Npy, ReadsEveryFormatVersion) {
  const std::string data = bytes<double>({1, 2, 3, 4, 5, 6.5});

  for (const int version : {1, 2, 3})
    EXPECT_EQ(read(npy(dictionary("<f8", false, "(2, 3)"), data, version)).samples, two_by_three);
}

TEST(Npy, ReadsHeadersLongerThan127Bytes) {
  const std::string header = dictionary("<f8", false, "(1, 1)") + std::string(150, ' ');

  EXPECT_EQ(read(npy(header, bytes<double>({7}))).samples, (Matrix{{7}}));
}

TEST(Npy, ReadsKeysInAnyOrderAndEitherQuotes) {
  const std::string header = R"({"shape":(1,2),"fortran_order":False,"descr":"<f8"})";

  EXPECT_EQ(read(npy(header, bytes<double>({7, 8}))).samples, (Matrix{{7, 8}}));
}

TEST(Npy, MakesOneColumnOfAVector) {
  const Recording clip = read(npy(dictionary("<f8", false, "(3,)"), bytes<double>({7, 8, 9})));

  EXPECT_EQ(clip.samples, (Matrix{{7}, {8}, {9}}));
  EXPECT_THAT(clip.columns, ElementsAre("column0"));
}

TEST(Npy, FlattensJointsInEitherOrder) {
  // Sample [frame, joint, axis] = 100 frame + 10 joint + axis, 2 x 2 x 3.
  const Matrix expected{{0, 1, 2, 10, 11, 12}, {100, 101, 102, 110, 111, 112}};

  const Recording c = read(npy(dictionary("<f8", false, "(2, 2, 3)"),
                               bytes<double>({0, 1, 2, 10, 11, 12, 100, 101, 102, 110, 111, 112})));
  const Recording fortran =
      read(npy(dictionary("<f8", true, "(2, 2, 3)"),
               bytes<double>({0, 100, 10, 110, 1, 101, 11, 111, 2, 102, 12, 112})));

  EXPECT_EQ(c.samples, expected);
  EXPECT_EQ(fortran.samples, expected);
  EXPECT_EQ(c.columns[5], "joint1.z");
}

TEST(Npy, GivesBackTheSameBits) {
  const test::TemporaryFolder folder;
  Recording clip;
  clip.samples = test::random_matrix(50, 7, 3);
  clip.samples(0, 0) = -0.0;
  clip.samples(4, 2) = test::nan;
  clip.samples(5, 2) = std::numeric_limits<double>::infinity();

  write_recording(folder.path() / "x.npy", clip);
  const Recording back = read(read_file(folder.path() / "x.npy"));

  EXPECT_TRUE(test::same_bits(back.samples, clip.samples));
}

TEST(Npy, WritesWhatNumpyWrites) {
  const test::TemporaryFolder folder;
  const char order = std::endian::native == std::endian::little ? '<' : '>';
  std::string header = dictionary(std::string(1, order) + "f8", false, "(2, 3)");
  header.resize(128 - 10 - 1, ' ');  // numpy aligns the samples to 64 bytes

  write_recording(folder.path() / "x.npy", {two_by_three, {}, 0, ""});

  EXPECT_THAT(read_file(folder.path() / "x.npy"), StartsWith(npy(header, "")));
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "x.npy"), 128 + 48);
}

// What is written of an array of a shape and type after `change` of its recording.
template <class Change>
std::string rewritten(const std::string& file, const Change& change,
                      const ReadOptions& options = {}) {
  Recording recording = read(file, options);
  change(recording);
  return npy_text(recording);
}

const auto nothing = [](Recording&) {};

TEST(NpyAgain, KeepsShapeTypeAndByteOrder) {
  const std::string data = bytes<float>({1, 2, 3, 4, 5, 6.5, 7, 8, 9, 10, 11, 12});
  const std::string changed = bytes<float>({1, 2, 3, 4, 5, 6.5, 7, 8, 9, 10, -0.25, 12});
  const auto set = [](Recording& recording) { recording.samples(1, 4) = -0.25; };
  const std::string file = npy_head({'<', 'f', 4}, {2, 2, 3}) + data;

  EXPECT_EQ(rewritten(file, nothing), file);
  EXPECT_EQ(rewritten(file, set), npy_head({'<', 'f', 4}, {2, 2, 3}) + changed);
  const std::string big = npy_head({'>', 'f', 8}, {1, 3}) + bytes<double>({1, 2, 3}, true);
  EXPECT_EQ(rewritten(big, nothing), big);
}

TEST(NpyAgain, WritesTheOrderOfCForThatOfFortran) {
  const std::string file = npy(dictionary("<f4", true, "(2, 3)"), bytes<float>({1, 4, 2, 5, 3, 6}));

  EXPECT_EQ(rewritten(file, nothing),
            npy_head({'<', 'f', 4}, {2, 3}) + bytes<float>({1, 2, 3, 4, 5, 6}));
}

TEST(NpyAgain, RoundsWholeNumbersAndLeavesThemWhereTheyCannotSayWhatIsMissing) {
  const NpyType type{'<', 'i', 2};
  const std::string file = npy_head(type, {2, 3}) + bytes<std::int16_t>({1, -2, 3, 4, 5, 6});

  EXPECT_EQ(read(file).samples, (Matrix{{1, -2, 3}, {4, 5, 6}}));
  EXPECT_EQ(rewritten(file, [](Recording& take) { take.samples(0, 1) = -7.6; }),
            npy_head(type, {2, 3}) + bytes<std::int16_t>({1, -8, 3, 4, 5, 6}));
  const double missing = test::nan;
  EXPECT_EQ(rewritten(file, [&](Recording& take) { take.samples(1, 2) = missing; }),
            npy_head({'<', 'f', 8}, {2, 3}) + bytes<double>({1, -2, 3, 4, 5, missing}));
  EXPECT_EQ(rewritten(file, [](Recording& take) { take.samples(0, 0) = 32767.5; }),
            npy_head({'<', 'f', 8}, {2, 3}) + bytes<double>({32767.5, -2, 3, 4, 5, 6}));
}

TEST(NpyAgain, ReadsHalfPrecisionAndRoundsToIt) {
  // 1.5 = 0x3E00, -2 = 0xC000, 1024 = 0x6400.
  const std::string head = npy_head({'<', 'f', 2}, {3});
  const std::string file = head + bytes<std::uint16_t>({0x3E00, 0xC000, 0x6400});

  EXPECT_EQ(read(file).samples, (Matrix{{1.5}, {-2}, {1024}}));
  EXPECT_EQ(rewritten(file, [](Recording& take) { take.samples(0, 0) = 1024.4; }),
            head + bytes<std::uint16_t>({0x6400, 0xC000, 0x6400}));
}

TEST(NpyAgain, PassesConfidencesThroughAndTakesPointsWithoutAnyForMissing) {
  const std::string head = npy_head({'<', 'f', 8}, {2, 1, 4});
  const std::string file = head + bytes<double>({1, 2, 3, 0.5, 4, 5, 6, 0});

  const Recording take = read(file);
  EXPECT_THAT(take.columns, ElementsAre("joint0.x", "joint0.y", "joint0.z"));
  EXPECT_TRUE(test::same_bits(take.samples, Matrix{{1, 2, 3}, {test::nan, test::nan, test::nan}}));
  EXPECT_TRUE(
      test::same_bits(take.confidence, Matrix{{0.5, 0.5, 0.5}, {test::nan, test::nan, test::nan}}));
  EXPECT_THAT(take.notes.passed_through, ElementsAre("joint0 confidence"));
  EXPECT_EQ(rewritten(file, nothing), file);  // 4, 5, 6 stay though they are not trusted
  EXPECT_EQ(rewritten(file, [](Recording& all) { all.samples.row(1) << 7, 8, 9; }),
            head + bytes<double>({1, 2, 3, 0.5, 7, 8, 9, 0.5}));
}

TEST(NpyAgain, DoesNotUseConfidencesThatAreAlwaysZero) {
  const std::string head = npy_head({'<', 'f', 8}, {2, 1, 4});
  const std::string file = head + bytes<double>({1, 2, 3, 0, 4, 5, 6, 0});

  const Recording take = read(file);
  EXPECT_EQ(take.samples, (Matrix{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_THAT(take.notes.warnings, ElementsAre("every confidence is 0: they are not used"));
  EXPECT_EQ(rewritten(file, nothing), file);
}

TEST(NpyAgain, WritesAPartOfTheFrames) {
  const std::string file =
      npy_head({'<', 'i', 4}, {3, 1, 2}) + bytes<std::int32_t>({1, 2, 3, 4, 5, 6});
  const auto last_two = [](Recording& take) { take = excerpt(take, 1, 3); };

  EXPECT_EQ(rewritten(file, last_two),
            npy_head({'<', 'i', 4}, {2, 1, 2}) + bytes<std::int32_t>({3, 4, 5, 6}));
}

// Confidences that are all 0 are not used: in a part of the frames they tell nothing.
TEST(NpyAgain, KeepsPointsMissingInAPartWhereNoConfidenceIsAboveZero) {
  for (const bool is_real : {true, false}) {
    const std::initializer_list<double> points = {1, 2, 3, 0, 4, 5, 6, 1};
    const Recording take =
        read(is_real ? npy(dictionary("<f8", false, "(2, 1, 4)"), bytes<double>(points))
                     : npy(dictionary("<i4", false, "(2, 1, 4)"), bytes<std::int32_t>(points)));
    ASSERT_EQ(take.samples.cols(), 3);

    const Recording back = read(npy_text(excerpt(take, 0, 1)));

    EXPECT_TRUE(back.samples.leftCols(3).array().isNaN().all());
  }
}

TEST(NpyAgain, KeepsMarksOfMissingSamplesThatStayMissing) {
  const test::TemporaryFolder folder;
  const std::string text =
      npy_head({'<', 'i', 2}, {2, 1, 3}) + bytes<std::int16_t>({1, 2, 3, -999, -999, -999});
  AtomicFile file(folder.path() / "x.npy");
  file.write(text);
  file.commit();

  ReadOptions marks;
  marks.missing = {-999};
  const Recording take = read_recording(folder.path() / "x.npy", marks);

  EXPECT_TRUE(take.samples.row(1).array().isNaN().all());
  EXPECT_EQ(npy_text(take), text);
}

}  // namespace
}  // namespace moclean
