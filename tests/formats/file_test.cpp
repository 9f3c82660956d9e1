#include "moclean/formats/file.hpp"

#include <thread>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "moclean/core/error.hpp"

#include "formats/temporary_folder.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(ReadFile, GivesEveryByte) {
  const test::TemporaryFolder folder;
  const std::string content("a\0b\r\n\xFF", 6);

  EXPECT_EQ(read_file(folder.file("x", content)), content);
  EXPECT_EQ(read_file(folder.file("empty", "")), "");
}

TEST(ReadFile, NamesAFileThatIsNotThere) {
  const test::TemporaryFolder folder;

  EXPECT_THAT([&] { read_file(folder.path() / "none.bvh"); },
              ThrowsMessage<FileError>(HasSubstr("none.bvh: there is no such file")));
  EXPECT_THAT([&] { read_file(folder.path()); },
              ThrowsMessage<FileError>(HasSubstr("expected a file, found a folder")));
}

TEST(AtomicFile, AppearsOnlyWhenComplete) {
  const test::TemporaryFolder folder;
  const fs::path target = folder.path() / "x.csv";
  AtomicFile file(target);

  file.write("half");
  const bool early = fs::exists(target);
  file.commit();

  EXPECT_FALSE(early);
  EXPECT_EQ(read_file(target), "half");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(AtomicFile, LeavesTheOldFileWhenAbandoned) {
  const test::TemporaryFolder folder;
  const fs::path target = folder.file("x.csv", "old");

  { AtomicFile(target).write("new"); }

  EXPECT_EQ(read_file(target), "old");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(AtomicFile, WaitsClosedForItsCommit) {
  const test::TemporaryFolder folder;
  const fs::path target = folder.path() / "x.csv";
  AtomicFile file(target);
  file.write("all");

  file.close();
  const bool early = fs::exists(target);
  AtomicFile moved = std::move(file);
  moved.commit();

  EXPECT_FALSE(early);
  EXPECT_EQ(moved.target(), target);
  EXPECT_EQ(read_file(target), "all");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(AtomicFile, LeavesNothingWhenAbandonedAfterItWasClosedAndMoved) {
  const test::TemporaryFolder folder;
  {
    AtomicFile file(folder.path() / "x.csv");
    file.close();
    const AtomicFile moved = std::move(file);
    EXPECT_EQ(files_in(folder.path()), 1);
  }

  EXPECT_EQ(files_in(folder.path()), 0);
}

TEST(AtomicFile, ReplacesTheOldFile) {
  const test::TemporaryFolder folder;
  const fs::path target = folder.file("x.csv", "old and longer");
  AtomicFile file(target);

  file.write("new");
  file.commit();

  EXPECT_EQ(read_file(target), "new");
}

TEST(AtomicFile, NamesAMissingFolder) {
  const test::TemporaryFolder folder;

  EXPECT_THAT([&] { AtomicFile(folder.path() / "none" / "x.csv"); },
              ThrowsMessage<FileError>(testing::AllOf(HasSubstr("x.csv: cannot be written"),
                                                      HasSubstr("there is no folder"))));
}

TEST(AtomicFile, RefusesTheNameOfAFolder) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder.path() / "x.csv");

  EXPECT_THROW(AtomicFile(folder.path() / "x.csv"), FileError);
}

TEST(AtomicFile, WritesToADeviceOrPipeAndLeavesItThere) {
  const test::TemporaryFolder folder;
  const std::filesystem::path pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::string read;
  std::jthread reader([&] { read = read_file(pipe); });

  {
    AtomicFile file(pipe);
    file.write("through");
    file.commit();
  }
  reader.join();

  EXPECT_EQ(read, "through");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(ReadFile, RefusesWhatIsNoFileOrPipe) {
  EXPECT_THAT([] { read_file("/dev/zero"); },
              ThrowsMessage<FileError>(HasSubstr("expected a file, found a device")));
}

TEST(ReadFile, RefusesWhatNoMemoryHolds) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.file("x.csv", "");
  fs::resize_file(file, std::uintmax_t{1} << 42);  // without a byte on the disk

  EXPECT_THAT([&] { read_file(file); },
              ThrowsMessage<FileError>(HasSubstr("do not fit into the memory")));
}

mode_t mode_of(const fs::path& file) {
  struct stat facts {};
  EXPECT_EQ(stat(file.c_str(), &facts), 0);
  return facts.st_mode & 07777;
}

TEST(AtomicFile, KeepsThePermissionsOfTheFileItReplaces) {
  const test::TemporaryFolder folder;
  const fs::path target = folder.file("x.csv", "old");
  ASSERT_EQ(chmod(target.c_str(), 0600), 0);
  AtomicFile file(target);

  const mode_t early = mode_of(file.temporary());
  file.commit();

  EXPECT_EQ(early, 0600u) << "nobody reads it meanwhile";
  EXPECT_EQ(mode_of(target), 0600u);
}

TEST(AtomicFile, WritesWhereALinkLeads) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder.path() / "there");
  const fs::path link = folder.path() / "x.csv", between = folder.path() / "y.csv";
  fs::create_symlink("y.csv", link);
  fs::create_symlink("there/z.csv", between);  // which is not there yet

  for (const char* text : {"first", "second"}) {
    AtomicFile file(link);
    file.write(text);
    file.commit();

    EXPECT_EQ(read_file(folder.path() / "there" / "z.csv"), text);
    EXPECT_TRUE(fs::is_symlink(link) && fs::is_symlink(between));
  }
}

TEST(AtomicFile, RefusesLinksThatGoRound) {
  const test::TemporaryFolder folder;
  fs::create_symlink("b.csv", folder.path() / "a.csv");
  fs::create_symlink("a.csv", folder.path() / "b.csv");

  EXPECT_THROW(AtomicFile(folder.path() / "a.csv"), FileError);
}

}  // namespace
}  // namespace moclean
