// Which files of a tree are takes.

#include "moclean/run/inputs.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "moclean/core/error.hpp"

#include "support/temporary_folder.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class Inputs : public ::testing::Test {
 protected:
  void touch(const std::string& name) const { folder_.write_text(name, ""); }

  // Of these inputs, as paths in the folder.
  std::vector<std::string> found(const std::vector<std::string>& names,
                                 const LeavesOut& leave_out = {}) const {
    std::vector<fs::path> inputs;
    for (const std::string& name : names) inputs.emplace_back(folder_ / name);
    std::vector<std::string> paths;
    for (const fs::path& file : expand_folders(inputs, leave_out))
      paths.push_back(file.lexically_relative(folder_ / "").string());
    return paths;
  }

  test::TemporaryFolder folder_;
};

TEST_F(Inputs, AreFoundAtAnyDepthSortedByPath) {
  for (const char* name : {"in/b.csv", "in/a/z.bvh", "in/a/deep/er/y.C3D", "in/notes.txt"})
    touch(name);

  EXPECT_THAT(found({"in"}), ElementsAre("in/a/deep/er/y.C3D", "in/a/z.bvh", "in/b.csv"));
}

TEST_F(Inputs, HiddenAndTemporaryFilesAndFoldersAreLeftOut) {
  for (const char* name : {"in/walk.csv", "in/.walk.csv", "in/.cache/walk.csv", "in/~$walk.csv",
                           "in/.walk.csv.0123456789abcdef.tmp", "in/walk.csv~"})
    touch(name);

  EXPECT_THAT(found({"in"}), ElementsAre("in/walk.csv"));
}

TEST_F(Inputs, KeptRawFilesAreLeftOutBesideWhatTheyWereKeptOf) {
  for (const char* name : {"in/walk.csv", "in/walk.raw.csv", "in/alone.raw.csv"}) touch(name);

  EXPECT_THAT(found({"in"}), ElementsAre("in/alone.raw.csv", "in/walk.csv"));
}

TEST_F(Inputs, WhatIsLeftOutIsAskedForFilesAndFolders) {
  for (const char* name : {"in/a.csv", "in/b.csv", "in/out/a.csv"}) touch(name);

  EXPECT_THAT(found({"in"},
                    [](const fs::path& path) {
                      return path.filename() == "out" || path.filename() == "b.csv";
                    }),
              ElementsAre("in/a.csv"));
}

TEST_F(Inputs, LinkedFoldersAreFollowedOnceAndRealOnesKeepTheirNames) {
  touch("in/real/a.csv");
  touch("elsewhere/b.csv");
  fs::create_directory_symlink(folder_ / "in/real", folder_ / "in/a_link");
  fs::create_directory_symlink(folder_ / "elsewhere", folder_ / "in/one");
  fs::create_directory_symlink(folder_ / "elsewhere", folder_ / "in/two");

  EXPECT_THAT(found({"in"}), ElementsAre("in/one/b.csv", "in/real/a.csv"));
}

TEST_F(Inputs, LinksThatLeadBackEndNothing) {
  touch("in/a/walk.csv");
  touch("beside.csv");
  fs::create_directory_symlink(folder_ / "in", folder_ / "in/a/loop");
  fs::create_directory_symlink("..", folder_ / "in/up");

  EXPECT_THAT(found({"in"}), ElementsAre("in/a/walk.csv"));
}

TEST_F(Inputs, GivenTwiceOrOverlappingEveryFileIsTakenOnce) {
  touch("in/a/walk.csv");
  touch("in/run.csv");

  EXPECT_THAT(found({"in/a", "in", "in/run.csv", "in/../in"}),
              ElementsAre("in/a/walk.csv", "in/run.csv"));
  EXPECT_THAT(found({"in/run.csv", "in/run.csv"}), ElementsAre("in/run.csv"));
  EXPECT_THAT(found({"in/a", "in/a"}), ElementsAre("in/a/walk.csv"));
}

TEST_F(Inputs, ALinkToAFileIsAFileOfItsOwn) {
  touch("in/a.csv");
  fs::create_symlink("a.csv", folder_ / "in/b.csv");
  fs::create_symlink("none.csv", folder_ / "in/broken.csv");

  EXPECT_THAT(found({"in"}), ElementsAre("in/a.csv", "in/b.csv"));
}

TEST_F(Inputs, AFolderWithoutRecordingsIsNamed) {
  touch("in/notes.txt");

  EXPECT_THAT([&] { found({"in"}); },
              ThrowsMessage<FileError>(HasSubstr("in: holds no recording (.bvh, ")));
  EXPECT_THAT([&] { found({"none.csv"}); },
              ThrowsMessage<FileError>(HasSubstr("none.csv: there is no such file or folder")));
}

TEST(RawName, StandsBeforeTheExtension) { EXPECT_EQ(raw_name("walk.1.BVH"), "walk.1.raw.BVH"); }

TEST_F(Inputs, AFolderThatCannotBeReadIsPassedByAndNamed) {
  if (geteuid() == 0) GTEST_SKIP() << "root reads every folder";
  for (const char* name : {"in/a.csv", "in/closed/b.csv", "in/z.csv"}) touch(name);
  fs::permissions(folder_ / "in/closed", fs::perms::none);
  PassedBy passed;

  const auto files = expand_folders({folder_ / "in"}, {}, &passed);

  EXPECT_THAT(files, ElementsAre(fs::path(folder_ / "in/a.csv"), fs::path(folder_ / "in/z.csv")));
  EXPECT_THAT(passed.unreadable, ElementsAre(fs::path(folder_ / "in/closed")));
  EXPECT_THAT(passed.problems, ElementsAre(HasSubstr("closed: cannot be read: Permission denied")));
  EXPECT_THROW(expand_folders({folder_ / "in"}), FileError);
  EXPECT_THROW(expand_folders({folder_ / "in/closed"}, {}, &passed), FileError);
  fs::permissions(folder_ / "in/closed", fs::perms::owner_all);
}

TEST_F(Inputs, WhatHasTheNameOfATakeAndIsNoneIsNamed) {
  touch("in/a.csv");
  fs::create_symlink("nothing", folder_ / "in/b.csv");
  fs::create_symlink("c.csv", folder_ / "in/c.csv");
  ASSERT_EQ(mkfifo((folder_ / "in/d.csv").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo((folder_ / "in/pipe").c_str(), 0600), 0);
  PassedBy passed;

  const auto files = expand_folders({folder_ / "in"}, {}, &passed);

  EXPECT_THAT(files, ElementsAre(fs::path(folder_ / "in/a.csv")));
  EXPECT_THAT(passed.skipped, ElementsAre(HasSubstr("b.csv: skipped, a link to nothing"),
                                          HasSubstr("c.csv: skipped, Too many levels of symbolic"),
                                          HasSubstr("d.csv: skipped, a pipe")));
}

}  // namespace
}  // namespace moclean
