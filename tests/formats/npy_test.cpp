#include "moclean/formats/npy.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

// What numpy.save writes, put together by hand.
std::string npy(const std::string& header, const std::string& data, int version = 1) {
  std::string file = "\x93NUMPY";
  file += static_cast<char>(version);
  file += '\0';
  const std::string line = header + "\n";
  for (int i = 0; i < (version == 1 ? 2 : 4); ++i)
    file += static_cast<char>(line.size() >> (8 * i) & 0xFF);
  return file + line + data;
}

std::string dictionary(const std::string& descr, bool fortran, const std::string& shape) {
  return fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': {}, }}", descr,
                     fortran ? "True" : "False", shape);
}

// Samples as bytes of the given type, least significant byte first or last.
template <class Real>
std::string bytes(std::initializer_list<double> values, bool big_endian = false) {
  std::string all;
  for (const double value : values) {
    const auto real = static_cast<Real>(value);
    std::string one(reinterpret_cast<const char*>(&real), sizeof real);
    if (big_endian != (std::endian::native == std::endian::big))
      std::reverse(one.begin(), one.end());
    all += one;
  }
  return all;
}

Recording read(const std::string& file) { return parse_npy(file, "x.npy"); }

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

}  // namespace
}  // namespace moclean
