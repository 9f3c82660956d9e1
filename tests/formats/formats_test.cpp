// What every format promises, whichever it is, and that texts for people say what the registry
// says.

#include "moclean/formats/formats.hpp"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"
#include "formats/tiny_files.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::same_bits;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

TEST(Formats, HaveExtensionsOfTheirOwn) {
  std::set<std::string_view> extensions, names;
  for (const Format* format : formats()) {
    EXPECT_TRUE(extensions.insert(format->extension).second) << format->name;
    EXPECT_TRUE(names.insert(format->name).second) << format->name;
    EXPECT_THAT(format->extension, testing::MatchesRegex("[.][a-z0-9]+"));
  }
}

TEST(Formats, CanEachBeReadOrWrittenAndSayWhatToKnow) {
  for (const Format* format : formats()) {
    EXPECT_TRUE(can_read(*format) || can_write(*format)) << format->name;
    EXPECT_FALSE(format->notes.empty()) << format->name;
  }
}

TEST(Formats, AreFoundByExtensionInAnyCase) {
  for (const Format* format : formats()) {
    std::string upper(format->extension);
    std::ranges::transform(upper, upper.begin(), [](char c) { return std::toupper(c); });

    EXPECT_EQ(format_of("a.b" + std::string(format->extension)), format);
    EXPECT_EQ(format_of("folder.d/take" + upper), format);
  }
  for (const char* other : {"take.text", "take", ".bvh", "take.bvh.gz", ""})
    EXPECT_EQ(format_of(other), nullptr) << other;
}

TEST(Formats, AreListedForHelpTextsAndForSentences) {
  EXPECT_EQ(listed_extensions(can_read), ".bvh .amc .c3d .trc .csv .tsv .txt .mot .sto .npy .npz");
  EXPECT_EQ(any_extension(can_read),
            ".bvh, .amc, .c3d, .trc, .csv, .tsv, .txt, .mot, .sto, .npy or .npz");
  EXPECT_EQ(any_extension(can_write),
            ".bvh, .amc, .c3d, .trc, .csv, .tsv, .txt, .mot, .sto, .npy or .npz");
  EXPECT_EQ(any_extension([](const Format& format) { return format.name == "BVH"; }), ".bvh");
  EXPECT_THAT(any_extension([](const Format&) { return false; }), IsEmpty());
}

TEST(Formats, AreAllNamedWhereAnExtensionIsUnknown) {
  const TemporaryFolder folder;
  const auto file = folder.file("take.xyz", "");

  EXPECT_THAT([&] { read_recording(file); },
              ThrowsMessage<FileError>(HasSubstr("file ending in " + any_extension(can_read))));
  EXPECT_THAT(
      [&] {
        write_recording(file, {Matrix{{1}}, {"a"}, 0, ""});
      },
      ThrowsMessage<FileError>(HasSubstr("name ending in " + any_extension(can_write))));
}

// What a format can hold of two samples of a point, the second of which is partly missing.
Matrix hip_samples(const FormatContent& content) {
  const double gap = test::nan;
  if (content.single_precision) return Matrix{{0.1F, -2e-30F, 1.F / 3}, {gap, gap, gap}};
  return Matrix{{0.1, -2e-300, 1. / 3}, {4, content.gaps ? gap : 5, 1e140}};
}

// The samples are the same bits whatever the format; all else is so if the format claims it.
TEST(Formats, ReadBackWhatTheyWrite) {
  const TemporaryFolder folder;
  for (const Format* format : formats()) {
    // Rotations hold positions to the last digits printed only: see bvh_write_test.cpp.
    if (!can_read(*format) || !can_write(*format) || has_skeleton(*format)) continue;
    SCOPED_TRACE(format->name);
    const FormatContent& content = format->content;
    const Recording recording{
        hip_samples(content), {"hip.x", "hip.y", "hip.z"}, 59.94, "mm", UpAxis::z};
    const auto file = folder.path() / ("take" + std::string(format->extension));

    write_recording(file, recording);
    const Recording back = read_recording(file);

    EXPECT_TRUE(same_bits(back.samples, recording.samples));
    EXPECT_EQ(back.columns, content.names ? recording.columns : default_column_names(3));
    EXPECT_EQ(back.frame_rate, content.frame_rate ? recording.frame_rate : 0);
    EXPECT_EQ(back.unit, content.unit ? recording.unit : "");
    EXPECT_EQ(back.up, content.up ? recording.up : std::nullopt);
  }
}

// A file of each format that can be read, with the most it can say.
class EachReadable : public testing::Test {
 protected:
  EachReadable() {
    folder_.file("tiny.asf", test::tiny_asf);
    folder_.file("tiny.bvh", test::tiny_bvh);
    folder_.file("tiny.amc", test::tiny_amc);
    folder_.file("tiny.trc", test::tiny_trc);
    folder_.file("tiny.csv", test::tiny_csv);
    folder_.file("tiny.tsv", test::tiny_csv);
    folder_.file("tiny.txt", test::tiny_csv);
    folder_.file("tiny.mot", test::tiny_mot);
    folder_.file("tiny.sto", test::tiny_mot);
    write_recording(folder_.path() / "tiny.npy", {Matrix{{1, 2, 3}}, {"a", "b", "c"}, 120, "mm"});
    write_recording(folder_.path() / "tiny.npz", {Matrix{{1, 2, 3}}, {"a", "b", "c"}, 120, "mm"});
    write_recording(folder_.path() / "tiny.c3d",
                    {Matrix{{1, 2, 3}}, {"hip.x", "hip.y", "hip.z"}, 120, "mm"});
  }

  std::filesystem::path file(const Format& format) const {
    return folder_.path() / ("tiny" + std::string(format.extension));
  }

  TemporaryFolder folder_;
};

TEST_F(EachReadable, SaysWhatItsFormatClaims) {
  for (const Format* format : formats()) {
    if (!can_read(*format)) continue;
    const Recording recording = read_recording(file(*format));

    EXPECT_GT(recording.samples.size(), 0) << format->name;
    EXPECT_EQ(recording.columns.size(), static_cast<std::size_t>(recording.samples.cols()))
        << format->name;
    EXPECT_EQ(recording.columns != default_column_names(recording.samples.cols()),
              format->content.names)
        << format->name;
    EXPECT_EQ(recording.frame_rate > 0, format->content.frame_rate) << format->name;
    EXPECT_EQ(!recording.unit.empty(), format->content.unit) << format->name;
    EXPECT_EQ(recording.skeleton.has_value(), format->content.skeleton) << format->name;
    EXPECT_EQ(recording.channels.rows(), format->content.skeleton ? recording.frames() : 0)
        << format->name;
    EXPECT_EQ(joint_parents(recording).empty(), !format->content.skeleton) << format->name;
  }
}

TEST_F(EachReadable, RefusesAnEmptyFileByName) {
  for (const Format* format : formats()) {
    if (!can_read(*format)) continue;
    const auto empty = folder_.file("tiny" + std::string(format->extension), "");

    EXPECT_THAT([&] { read_recording(empty); },
                ThrowsMessage<FileError>(HasSubstr(empty.string())));
  }
}

TEST(FormatTexts, AreThoseOfTheReadme) {
  const std::string readme = read_file(std::filesystem::path(MOCLEAN_SOURCE_DIR) / "README.md");
  for (const Format* format : formats()) {
    const auto yes = [](bool is) { return is ? " yes |" : " |"; };
    std::string row = "| " + std::string(format->name) + " |" + yes(can_read(*format)) +
                      yes(can_write(*format)) + " " + std::string(format->notes) + " |\n";
    EXPECT_THAT(readme, HasSubstr(row));
  }
}

TEST(FormatTexts, OfOtherDocumentsNameTheSameExtensions) {
  const std::filesystem::path docs = std::filesystem::path(MOCLEAN_SOURCE_DIR) / "docs";

  EXPECT_THAT(read_file(docs / "experiment.md"),
              HasSubstr("| `[[take]] file` | " + listed_extensions(can_read) + ";"));
  EXPECT_THAT(read_file(docs / "metrics.md"),
              HasSubstr("a skeleton: TRUTH in " + any_extension(has_skeleton) + ","));
}

}  // namespace
}  // namespace moclean
