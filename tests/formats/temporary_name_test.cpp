#include "moclean/formats/temporary_name.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "moclean/formats/file.hpp"
#include "moclean/formats/unfinished.hpp"

#include "formats/temporary_folder.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

std::size_t count_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

// What a process that ends without destructors leaves.
void leave(const fs::path& target) {
  const pid_t child = fork();
  if (child == 0) {
    const AtomicFile file(target);
    _exit(fs::exists(file.temporary()) ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
}

TEST(TemporaryName, IsLegalWhereTheTargetIs) {
  for (const std::size_t length : {1u, 95u, 96u, 97u, 244u, 255u}) {
    const std::string name(length, 'x');

    const fs::path temporary = temporary_beside(fs::path("folder") / name);

    EXPECT_EQ(temporary.parent_path(), "folder");
    EXPECT_LE(temporary.filename().string().size(), 143u) << length;
    EXPECT_TRUE(is_temporary_of(temporary, name)) << length;
    EXPECT_FALSE(is_temporary_of(temporary, "y" + name)) << length;
  }
}

TEST(TemporaryName, IsNoOtherName) {
  const std::string name = temporary_beside("x.csv").string();

  EXPECT_FALSE(is_temporary_of("x.csv", "x.csv"));
  EXPECT_FALSE(is_temporary_of(name.substr(1), "x.csv"));
  EXPECT_FALSE(is_temporary_of(name + "x", "x.csv"));
  EXPECT_FALSE(is_temporary_of(".x.csv.0123456789abcdef0123456g.tmp", "x.csv"));
}

TEST(RemoveLeftIn, RemovesWhatADeadProcessHasLeft) {
  const test::TemporaryFolder folder;
  leave(folder.path() / "x.csv");
  leave(folder.path() / std::string(250, 'y'));
  ASSERT_EQ(count_in(folder.path()), 2u);

  remove_left_in(folder.path());

  EXPECT_EQ(count_in(folder.path()), 0u);
}

TEST(RemoveLeftIn, LeavesWhatIsOfOthers) {
  const test::TemporaryFolder folder;
  const AtomicFile ours(folder.path() / "x.csv");
  const std::string name = temporary_beside("y.csv").string();
  std::string of_parent = name, elsewhere = name;
  of_parent.replace(7 + 8, 8, fmt::format("{:08x}", getppid()));
  elsewhere.replace(7, 8, name.substr(7, 8) == "00000000" ? "00000001" : "00000000");
  for (const std::string& other :
       {of_parent, elsewhere, std::string(".hidden"), std::string(".y.csv.tmp")})
    folder.file(other, "of somebody else");

  remove_left_in(folder.path());

  EXPECT_EQ(count_in(folder.path()), 5u);
}

TEST(RemoveLeftIn, RemovesWhatAnEarlierProcessOfOurNumberHasLeft) {
  const test::TemporaryFolder folder;
  folder.file(temporary_beside("x.csv").string(), "of an earlier container, say");

  remove_left_in(folder.path());

  EXPECT_EQ(count_in(folder.path()), 0u);
}

TEST(Unfinished, IsRemovedAndNothingComesAfter) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder.path() / "kept");
  const pid_t child = fork();
  if (child == 0) {
    const fs::path made = folder.path() / "kept" / "made";
    make_unfinished(made, [&] { return fs::create_directory(made); });
    AtomicFile file(made / "x.csv");
    AtomicFile whole(folder.path() / "kept" / "whole.csv");
    whole.commit();
    remove_unfinished();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);

  EXPECT_EQ(status, 0);
  EXPECT_EQ(count_in(folder.path() / "kept"), 1u);
  EXPECT_TRUE(fs::exists(folder.path() / "kept" / "whole.csv"));
}

}  // namespace
}  // namespace moclean
