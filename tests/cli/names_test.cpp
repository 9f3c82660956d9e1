// Names of files that are no plain text, folders that cannot be read, pipes among takes.

#include <filesystem>

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/batch_folder.hpp"

namespace moclean::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class Names : public ::testing::Test {
 protected:
  Outcome denoise(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {folder_ / "in", "-o", folder_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return denoise_quickly(arguments);
  }

  TemporaryFolder folder_;
};

// A name with a line feed could print lines that look like ours.
TEST_F(Names, ControlNeitherTerminalNorLines) {
  const std::vector<std::string> names = {"a\nmoclean: forged.csv", "b\x1b[31m.csv",
                                          "c\u202Evsc.csv", "d\xff.csv"};
  for (const std::string& name : names) folder_.write("in/" + name, small_walk(30));
  folder_.write_text("in/e\nf.csv", "a\nx\n");
  const std::vector<std::vector<std::string>> commands = {
      {"denoise", folder_ / "in", "-o", folder_ / "out", "--method", "median"},
      {"denoise", folder_ / "in", "-o", folder_ / "out", "--method", "median", "--dry-run"},
      {"info", folder_ / ("in/" + names[0])},
      {"info", folder_ / "in/e\nf.csv"},
      {"convert", folder_ / ("in/" + names[0]), folder_ / "x\ny.npy"},
      {"denoise", folder_ / ("in/" + names[0]), "-o", folder_ / "x\ny.csv", "--unknown\nz"}};
  for (const auto& command : commands) {
    const Outcome outcome = run(command);

    for (const std::string& text : {outcome.out, outcome.err}) {
      EXPECT_THAT(text, Not(AnyOf(HasSubstr("\nmoclean: forged"), HasSubstr("\nf.csv"),
                                  HasSubstr("\ny.npy"), HasSubstr("\x1b"), HasSubstr("\xff"),
                                  HasSubstr("\u202E"))))
          << ::testing::PrintToString(command);
    }
  }
}

TEST_F(Names, StandInRecordsAsTheyAre) {
  folder_.write("in/a\nb\"\\.csv", small_walk(30));

  const Outcome outcome = denoise({"--lines", "-", "--json", folder_ / "record.json"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string name = folder_ / "in/a\nb\"\\.csv";
  EXPECT_EQ(lines_of(outcome.out)[0]["file"], name);
  EXPECT_EQ(nlohmann::json::parse(content(folder_ / "record.json"))["inputs"][0]["file"], name);
  EXPECT_EQ(lines_of(denoise({"--resume", "--lines", "-"}).out)[0]["left_out"], "done before");
}

TEST_F(Names, OfPipesAndBrokenLinksAreSkippedWithAWord) {
  folder_.write("in/a.csv", small_walk(30));
  fs::create_symlink("nothing", folder_ / "in/b.csv");
  ASSERT_EQ(mkfifo((folder_ / "in/c.csv").c_str(), 0600), 0);
  fs::create_directory_symlink(".", folder_ / "in/again");

  const Outcome outcome = denoise();

  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("b.csv: skipped, a link to nothing"),
                                 HasSubstr("c.csv: skipped, a pipe")));
  EXPECT_THAT(files_below(folder_, "out"), ElementsAre("a.csv", "moclean.manifest.jsonl"));
}

// As somebody who may not read everything.
class AsNobody {
 public:
  AsNobody() : was_root_(geteuid() == 0) {
    if (was_root_) become(65534);
  }
  ~AsNobody() {
    if (was_root_) become(0);
  }
  AsNobody(const AsNobody&) = delete;
  AsNobody& operator=(const AsNobody&) = delete;

 private:
  static void become(uid_t user) {
    if (seteuid(user) != 0) throw std::runtime_error("seteuid");
  }

  bool was_root_;
};

TEST_F(Names, OfAFolderThatCannotBeReadIsToldAndTheRestIsCleaned) {
  folder_.write("in/a.csv", small_walk(30));
  folder_.write("in/closed/b.csv", small_walk(30));
  fs::create_directory(folder_ / "out");
  for (const char* name : {"", "in", "out"}) ASSERT_EQ(chmod((folder_ / name).c_str(), 0777), 0);
  ASSERT_EQ(chmod((folder_ / "in/closed").c_str(), 0), 0);

  Outcome outcome, all_or_nothing;
  {
    const AsNobody nobody;
    if (access(MOCLEAN_PROGRAM, X_OK) != 0 || eaccess(MOCLEAN_PROGRAM, X_OK) != 0)
      GTEST_SKIP() << "nobody may run " MOCLEAN_PROGRAM;
    outcome = denoise({"--json", folder_ / "record.json", "--lines", folder_ / "lines"});
    all_or_nothing = denoise({"--all-or-nothing"});
  }

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("in/closed: cannot be read: Permission denied"));
  EXPECT_TRUE(fs::exists(folder_ / "out/a.csv"));
  const auto record = nlohmann::json::parse(content(folder_ / "record.json"));
  EXPECT_EQ(record["unreadable_folders"][0]["folder"], folder_ / "in/closed");
  EXPECT_EQ(lines_of(content(folder_ / "lines"))[0]["folder"], folder_ / "in/closed");
  EXPECT_EQ(all_or_nothing.exit_code, 1);
  chmod((folder_ / "in/closed").c_str(), 0700);
}

}  // namespace
}  // namespace moclean::test
