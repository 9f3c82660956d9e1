// Every path that a command is given against every other, and what becomes of links and modes.

#include <filesystem>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "cli/batch_folder.hpp"

namespace moclean::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;

class Paths : public ::testing::Test {
 protected:
  // The files of a run: every command reads some and writes some.
  void SetUp() override {
    for (const char* name : {"in.csv", "truth.csv", "other.csv"})
      folder_.write(name, small_walk(30));
    folder_.write_text("config.toml", "method = \"median\"\n");
    fs::create_symlink("in.csv", folder_ / "link.csv");
    fs::create_hard_link(folder_ / "in.csv", folder_ / "hard.csv");
  }

  void expect_refused(const std::vector<std::string>& command) {
    const auto before = contents_below(folder_, ".");
    std::vector<std::pair<std::string, std::string>> all;
    for (const std::string& name : folder_.names()) all.emplace_back(name, content(folder_ / name));

    const Outcome outcome = run(command);

    EXPECT_EQ(outcome.exit_code, 2) << ::testing::PrintToString(command);
    EXPECT_THAT(outcome.err, AnyOf(HasSubstr("is an input"), HasSubstr("would both write"),
                                   HasSubstr("which it would replace")))
        << ::testing::PrintToString(command);
    for (const auto& [name, bytes] : all) EXPECT_TRUE(content(folder_ / name) == bytes) << name;
    EXPECT_EQ(folder_.names().size(), all.size());
  }

  TemporaryFolder folder_;
};

TEST_F(Paths, OfRecordsReplaceNothing) {
  for (const char* record : {"--json", "--lines"})
    for (const char* name : {"in.csv", "link.csv", "hard.csv", "truth.csv", "config.toml",
                             "out.csv", "mask.csv", "./out.csv"})
      expect_refused({"denoise", folder_ / "in.csv", "-o", folder_ / "out.csv", "--truth",
                      folder_ / "truth.csv", "--mask", folder_ / "mask.csv", "--config",
                      folder_ / "config.toml", record, folder_ / name});
  expect_refused({"denoise", folder_ / "in.csv", "-o", folder_ / "out.csv", "--method", "median",
                  "--json", folder_ / "r", "--lines", folder_ / "./r"});
}

TEST_F(Paths, OfResultsDiffer) {
  expect_refused({"corrupt", folder_ / "in.csv", "-o", folder_ / "out.csv", "--noise",
                  "gaussian:sd=1", "--mask", folder_ / "./out.csv"});
  fs::create_symlink("out.csv", folder_ / "to-out.csv");
  expect_refused({"corrupt", folder_ / "other.csv", "-o", folder_ / "out.csv", "--noise",
                  "gaussian:sd=1", "--mask", folder_ / "to-out.csv"});
}

TEST_F(Paths, ALinkThatGoesRoundIsAnError) {
  fs::create_symlink("loop.csv", folder_ / "loop.csv");

  const Outcome outcome = run({"convert", folder_ / "in.csv", folder_ / "loop.csv"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("loop.csv: cannot be written"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "loop.csv"));
}

// A link stays one, what it leads to gets the bytes and keeps its permissions.
TEST_F(Paths, OfOutputsKeepLinksAndModes) {
  const auto mode = [](const fs::path& file) {
    return static_cast<int>(fs::status(file).permissions());
  };
  for (const std::string target : {"there.csv", "new.csv"}) {
    fs::create_symlink(target, folder_ / "result.csv");
    if (target == "there.csv") {
      folder_.write_text(target, "before");
      ASSERT_EQ(chmod((folder_ / target).c_str(), 0640), 0);
    }
    for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
             {"convert", folder_ / "in.csv", folder_ / "result.csv"},
             {"corrupt", folder_ / "in.csv", "-o", folder_ / "result.csv", "--noise",
              "gaussian:sd=1"},
             {"denoise", folder_ / "in.csv", "-o", folder_ / "result.csv", "--method", "median"},
             {"denoise", folder_ / "in.csv", "-o", folder_ / "o.csv", "--method", "median",
              "--json", folder_ / "result.csv"},
             {"denoise", folder_ / "in.csv", "-o", folder_ / "o.csv", "--method", "median",
              "--lines", folder_ / "result.csv"}}) {
      EXPECT_EQ(run(command).exit_code, 0) << ::testing::PrintToString(command);

      EXPECT_TRUE(fs::is_symlink(folder_ / "result.csv"));
      EXPECT_GT(content(folder_ / target).size(), 100u);
      if (target == "there.csv") {
        EXPECT_EQ(mode(folder_ / target), 0640);
      }
    }
    fs::remove(folder_ / "result.csv");
  }
}

TEST_F(Paths, OfDevicesAndStandardOutputAreWrittenTo) {
  const std::vector<std::string> denoise = {
      "denoise",  folder_ / "in.csv", "-o",      folder_ / "o.csv",
      "--method", "median",           "--quiet", "--json"};
  auto to_null = denoise, to_output = denoise;
  to_null.emplace_back("/dev/null");
  to_output.emplace_back("/dev/stdout");

  EXPECT_EQ(run(to_null).exit_code, 0);
  const Outcome shown = run(to_output);

  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_TRUE(shown.json().contains("inputs"));
}

TEST_F(Paths, MayHaveNamesAsLongAsTheSystemAllows) {
  const std::string name = std::string(251, 'x') + ".csv";

  EXPECT_EQ(run({"convert", folder_ / "in.csv", folder_ / name}).exit_code, 0);
  EXPECT_EQ(
      run({"denoise", folder_ / name, "-o", folder_ / "out/", "--method", "median"}).exit_code, 0);

  EXPECT_TRUE(fs::exists(folder_ / ("out/" + name)));
}

TEST_F(Paths, OfInputsMayBeginLikeOptions) {
  fs::copy(folder_ / "in.csv", folder_ / "-x.csv");
  fs::copy(folder_ / "in.csv", folder_ / "--json.csv");
  const fs::path here = fs::current_path();
  fs::current_path(folder_ / "");
  for (const char* name : {"-x.csv", "--json.csv"})
    for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
             {"denoise", "-o", "o.csv", "--method", "median", "--", name},
             {"info", "--", name},
             {"convert", "--", name, "o.csv"}}) {
      const Outcome outcome = run(command);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    }
  fs::current_path(here);
}

}  // namespace
}  // namespace moclean::test
