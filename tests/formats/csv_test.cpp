#include "moclean/formats/csv.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"
#include "formats/tiny_files.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::same_bits;
using testing::ElementsAre;

Recording read(std::string_view text) { return parse_csv(text, "tiny.csv"); }

TEST(Csv, ReadsNamesCommentsAndNumbers) {
  const Recording clip = read(test::tiny_csv);

  EXPECT_THAT(clip.columns, ElementsAre("hip, left", "hip.y", "hip.z"));
  EXPECT_EQ(clip.frame_rate, 120);
  EXPECT_EQ(clip.unit, "mm");
  EXPECT_EQ(clip.samples.row(0), (Matrix{{1.5, -2, 3e-3}}));
  EXPECT_TRUE(clip.samples.row(1).array().isNaN().all());
}

TEST(Csv, AcceptsEveryLineEndAndBlank) {
  const Matrix expected{{1, 2}, {3, 4}};

  for (const char* text : {"a,b\n1,2\n3,4", "a,b\r\n1,2\r\n3,4\r\n", "a,b\r1,2\r3,4\r",
                           "\xEF\xBB\xBF"
                           "a,b\n1,2\n3,4\n",
                           "a , b\n 1,\t2 \n\n +3 , 4e0\n\n", "\n# x\n\na,b\n1,2\n3,4\n"}) {
    const Recording clip = read(text);
    EXPECT_EQ(clip.samples, expected) << text;
    EXPECT_THAT(clip.columns, ElementsAre("a", "b")) << text;
  }
}

TEST(Csv, TakesTheSeparatorFromTheHeader) {
  for (const char* text : {"a;b;c\n1;;3\n", "a\tb\tc\n1\t\t3\n", "a,b,c\n1,,3\n"}) {
    const Recording clip = read(text);
    EXPECT_THAT(clip.columns, ElementsAre("a", "b", "c")) << text;
    EXPECT_EQ(clip.samples(0, 0), 1) << text;
    EXPECT_TRUE(std::isnan(clip.samples(0, 1))) << text;
    EXPECT_EQ(clip.samples(0, 2), 3) << text;
  }
}

TEST(Csv, ReadsALeadingAndATrailingEmptyCell) {
  for (const char* text : {"a\tb\n\t2\n1\t\n", "a,b\n,2\n1,\n"}) {
    const Recording clip = read(text);
    ASSERT_EQ(clip.frames(), 2) << text;
    EXPECT_TRUE(std::isnan(clip.samples(0, 0)) && std::isnan(clip.samples(1, 1))) << text;
    EXPECT_EQ(clip.samples(0, 1), 2) << text;
  }
}

TEST(Csv, TakesTheRateFromATimeColumn) {
  for (const char* name : {"time", "Time", "t(s)", "Time [s]", "T"}) {
    const Recording clip = read(fmt::format("{},a\n0,1\n0.01,2\n0.02,3\n", name));
    EXPECT_EQ(clip.frame_rate, 100) << name;
    EXPECT_THAT(clip.columns, ElementsAre("a")) << name;
    EXPECT_EQ(clip.samples, (Matrix{{1}, {2}, {3}})) << name;
  }
}

TEST(Csv, EvensOutRoundedTimesAndIgnoresGapsInThem) {
  std::string text = "time,a\n";
  for (int f = 0; f < 121; ++f)
    if (f < 40 || f > 60) text += fmt::format("{:.3f},1\n", f / 120.0);

  EXPECT_NEAR(read(text).frame_rate, 120, 1);  // a rounding of 1 ms over 39 and 60 steps
}

TEST(Csv, LetsTheCommentStateTheRateBesideATimeColumn) {
  EXPECT_EQ(read("# frame_rate: 50\ntime,a\n0,1\n0.01,2\n").frame_rate, 50);
}

TEST(Csv, LeavesTheRateUnknownWhereNothingStatesIt) {
  EXPECT_EQ(read("a,b\n1,2\n").frame_rate, 0);
  EXPECT_EQ(read("time,b\n1,2\n").frame_rate, 0);
}

TEST(Csv, GivesBackTheSameBits) {
  const test::TemporaryFolder folder;
  Random random(5);
  Recording clip;
  clip.samples = Matrix(200, 7);
  for (double& x : clip.samples.reshaped<Eigen::RowMajor>())  // any finite bit pattern
    do x = std::bit_cast<double>(random.below(UINT64_MAX));
    while (!std::isfinite(x));
  clip.samples.row(0) << 0.0, -0.0, std::numeric_limits<double>::denorm_min(),
      std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest(), 0.1, -1.0 / 3;
  clip.samples(3, 2) = clip.samples(199, 6) = test::nan;
  clip.columns = {"a.x",
                  "with, comma",
                  "with \"quotes\"",
                  " blank ",
                  "#",
                  "Gr\xC3\xB6\xC3\x9F"
                  "e",
                  ""};
  clip.frame_rate = 119.88;
  clip.unit = "ASF units";

  write_recording(folder.path() / "x.csv", clip);
  const Recording back = parse_csv(read_file(folder.path() / "x.csv"), "x.csv");

  EXPECT_TRUE(same_bits(back.samples, clip.samples));
  EXPECT_EQ(back.columns, clip.columns);
  EXPECT_EQ(back.frame_rate, clip.frame_rate);
  EXPECT_EQ(back.unit, clip.unit);
}

TEST(Csv, RefusesToWriteANameWithALineBreak) {
  const test::TemporaryFolder folder;
  const Recording clip{Matrix{{1}}, {"a\nb"}, 0, ""};

  EXPECT_THROW(write_recording(folder.path() / "x.csv", clip), FileError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace moclean
