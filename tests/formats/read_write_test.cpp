#include "moclean/formats/read_write.hpp"

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/find_skeleton.hpp"

#include "formats/temporary_folder.hpp"
#include "formats/tiny_files.hpp"
#include "support/matrix.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(ReadRecording, ChoosesTheFormatByExtensionInAnyCase) {
  const TemporaryFolder folder;
  folder.file("tiny.ASF", test::tiny_asf);

  EXPECT_EQ(read_recording(folder.file("a.bvh", test::tiny_bvh)).columns[3], "knee.x");
  EXPECT_EQ(read_recording(folder.file("b.BVH", test::tiny_bvh)).columns[3], "knee.x");
  EXPECT_EQ(read_recording(folder.file("tiny.Amc", test::tiny_amc)).columns[3], "thigh.x");
  EXPECT_EQ(read_recording(folder.file("d.Csv", test::tiny_csv)).columns[1], "hip.y");
}

TEST(ReadRecording, NamesTheExtensionsItReads) {
  const TemporaryFolder folder;

  for (const char* name : {"x.text", "x", "x.asf", ".bvh"})
    EXPECT_THAT([&] { read_recording(folder.file(name, "")); },
                ThrowsMessage<FileError>(
                    AllOf(HasSubstr(name), HasSubstr("expected a file ending in .bvh, .amc"))));
}

TEST(ReadRecording, TakesTheRateOptionWhereTheFileStatesNoneAndOfBvhAndTablesAlways) {
  const TemporaryFolder folder;
  const ReadOptions options{.skeleton = folder.file("s.asf", test::tiny_asf), .rate = 60};

  EXPECT_EQ(read_recording(folder.file("a.bvh", test::tiny_bvh), options).frame_rate, 60);
  EXPECT_EQ(read_recording(folder.file("a.amc", test::tiny_amc), options).frame_rate, 60);
  EXPECT_EQ(read_recording(folder.file("a.csv", "a,b\n1,2\n"), options).frame_rate, 60);
  EXPECT_EQ(read_recording(folder.file("b.csv", test::tiny_csv), options).frame_rate, 60);
}

TEST(ReadRecording, BlamesTheFileThatIsWrong) {
  const TemporaryFolder folder;
  folder.file("tiny.asf", ":root\n order TX\n:bonedata\n begin\n length x\n");

  EXPECT_THAT([&] { read_recording(folder.file("tiny.amc", test::tiny_amc)); },
              ThrowsMessage<FileError>(HasSubstr("tiny.asf:5: expected a number, found 'x'")));
}

TEST(ReadRecording, HasTheSkeletonOfTheFileOrOfTheOptionIfThatFits) {
  const TemporaryFolder folder;
  const fs::path asf = folder.file("tiny.asf", test::tiny_asf);
  const fs::path amc = folder.file("tiny.amc", test::tiny_amc);
  const fs::path bvh = folder.file("a.bvh", test::tiny_bvh);
  const fs::path fits = folder.path() / "fits.csv", other = folder.file("a.csv", test::tiny_csv);
  write_recording(fits, read_recording(amc));

  EXPECT_EQ(read_recording(bvh).skeleton->bones[2].name, "foot");
  EXPECT_EQ(read_recording(bvh, {.skeleton = asf}).skeleton->bones[2].name, "foot");
  EXPECT_EQ(read_recording(amc).skeleton->bones[1].name, "thigh");
  EXPECT_EQ(read_recording(fits, {.skeleton = asf}).skeleton->bones[1].name, "thigh");
  EXPECT_EQ(read_recording(fits, {.skeleton = asf}).channels.size(), 0);
  EXPECT_FALSE(read_recording(other, {.skeleton = asf}).skeleton);
  EXPECT_FALSE(read_recording(fits).skeleton);
}

TEST(WriteRecording, ChoosesTheFormatByExtension) {
  const TemporaryFolder folder;
  const Recording clip{Matrix{{1, 2}, {3, 4}}, {"a", "b"}, 0, ""};

  for (const char* name : {"x.csv", "x.NPY"}) {
    write_recording(folder.path() / name, clip);
    EXPECT_EQ(read_recording(folder.path() / name).samples, clip.samples) << name;
  }
  EXPECT_THAT([&] { write_recording(folder.path() / "x.asf", clip); },
              ThrowsMessage<FileError>(
                  HasSubstr("expected a name ending in .bvh, .amc, .c3d, .trc, .csv")));
}

TEST(WriteRecording, KeepsTheOldFileWhenItFails) {
  const TemporaryFolder folder;
  const fs::path target = folder.file("x.csv", "old");
  const Recording unwritable{Matrix{{1}}, {"line\nbreak"}, 0, ""};

  EXPECT_THROW(write_recording(target, unwritable), FileError);

  EXPECT_EQ(read_file(target), "old");
}

struct Lookup {
  std::string amc;
  std::vector<std::string> there;
  std::string found;
};

class FindSkeleton : public testing::TestWithParam<Lookup> {};

TEST_P(FindSkeleton, TakesTheClosestName) {
  const TemporaryFolder folder;
  for (const std::string& name : GetParam().there) folder.file(name, "");

  EXPECT_EQ(find_skeleton(folder.path() / GetParam().amc).filename(), GetParam().found);
}

INSTANTIATE_TEST_SUITE_P(
    Each, FindSkeleton,
    testing::Values(Lookup{"14_06.amc", {"14_06.asf", "14.asf", "b.asf"}, "14_06.asf"},
                    Lookup{"14_06.amc", {"14.asf", "1.asf", "06.asf"}, "14.asf"},
                    Lookup{"HDM_bd_x.amc", {"HDM.asf", "HDM_bd.asf", "HDM_bk.asf"}, "HDM_bd.asf"},
                    Lookup{"HDM_bd_x_1_2.amc", {"HDM.asf", "other.asf"}, "HDM.asf"},
                    Lookup{"14_06.AMC", {"14.ASF", "15.ASF"}, "14.ASF"},
                    Lookup{"walk.amc", {"actor.asf", "actor.amc"}, "actor.asf"},
                    Lookup{"_x.amc", {"actor.asf"}, "actor.asf"}));

TEST(FindSkeleton, SaysWhatItLookedFor) {
  const TemporaryFolder folder;
  folder.file("a.asf", "");
  folder.file("b.asf", "");

  EXPECT_THAT([&] { find_skeleton(folder.path() / "HDM_bd_x.amc"); },
              ThrowsMessage<FileError>(
                  AllOf(HasSubstr("HDM_bd_x.amc: has no skeleton"),
                        HasSubstr("HDM_bd_x.asf, HDM_bd.asf, HDM.asf, or a single .asf"),
                        HasSubstr("there are 2"))));
}

}  // namespace
}  // namespace moclean
