// moclean denoise --config: settings of a file, of folders, and those of the command line.

#include <gmock/gmock.h>

#include "moclean/formats/read_write.hpp"

#include "cli/batch_folder.hpp"

namespace moclean::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Config : public ::testing::Test {
 protected:
  Config() {
    folder_.write("in/walks/slow/a.csv", small_walk(60, 1));
    folder_.write("in/walks/b.csv", small_walk(61, 2));
    folder_.write("in/runs/c.csv", small_walk(62, 3));
  }

  // Of the folder `in` with this configuration; the method of every take that was cleaned.
  Outcome denoise(const std::string& config, std::vector<std::string> more = {}) const {
    more.insert(more.begin(),
                {"denoise", folder_ / "in", "-o", folder_ / "out", "--config",
                 folder_.write_text("takes.toml", config), "--lines", folder_ / "lines.jsonl"});
    return run(more);
  }

  std::string method_of(const std::string& take) const {
    for (const nlohmann::json& line : lines_of(content(folder_ / "lines.jsonl")))
      if (line["file"].get<std::string>().ends_with(take)) return line["method"];
    return "none";
  }

  TemporaryFolder folder_;
};

TEST_F(Config, SettingsOfInnerFoldersGoBeforeThoseOfOuterOnes) {
  const Outcome outcome = denoise(R"(
method = "median"
jobs = 1

[[folder]]
path = "walks/slow"
method = "hampel:window=7,sigmas=3"

[[folder]]
path = "walks/"
method = "median:window=5"
frames = "0:40"
)");

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(method_of("a.csv"), StartsWith("hampel:window=7,sigmas=3"));
  EXPECT_EQ(method_of("b.csv"), "median:window=5");
  EXPECT_EQ(method_of("c.csv"), "median:window=7");
  EXPECT_EQ(read_recording(folder_ / "out/walks/slow/a.csv").frames(), 40);
  EXPECT_EQ(read_recording(folder_ / "out/runs/c.csv").frames(), 62);
}

TEST_F(Config, TakesOfAFolderComeOutAsIfTheyWereCleanedAlone) {
  ASSERT_EQ(
      denoise("method = \"median\"\n[[folder]]\npath = \"walks\"\nmethod = \"hampel\"\n").exit_code,
      0);

  for (const auto& [take, method] :
       {std::pair{"walks/b.csv", "hampel"}, {"runs/c.csv", "median"}}) {
    const std::string alone = folder_ / "alone.csv";
    ASSERT_EQ(
        run({"denoise", folder_ / (std::string("in/") + take), "-o", alone, "--method", method})
            .exit_code,
        0);
    EXPECT_EQ(content(folder_ / (std::string("out/") + take)), content(alone)) << take;
  }
}

TEST_F(Config, TheCommandLineGoesBeforeEverything) {
  const Outcome outcome =
      denoise("method = \"median\"\n[[folder]]\npath = \"walks\"\nmethod = \"hampel\"\n",
              {"--method", "median:window=3"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* take : {"a.csv", "b.csv", "c.csv"})
    EXPECT_EQ(method_of(take), "median:window=3");
}

TEST_F(Config, AnOptionReplacesThoseThatItExcludes) {
  const Outcome outcome = denoise(
      "method = \"slra\"\nbackend = \"reference\"\nsegment-length = 20\n", {"--segments", "2"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(method_of("a.csv"), HasSubstr("segments=2"));
}

TEST_F(Config, AFolderMayTakeAFlagBack) {
  const Outcome outcome = denoise(
      "method = \"median\"\nkeep-observed = true\nmissing = [0, -9999]\n[[folder]]\npath = "
      "\"walks\"\nkeep-observed = false\n",
      {"--resume"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string manifest = content(folder_ / "out/moclean.manifest.jsonl");
  for (const nlohmann::json& line : lines_of(manifest)) {
    const bool is_walk = line["output"].get<std::string>().starts_with("walks");
    EXPECT_EQ(line["parameters"]["keep_observed"], !is_walk);
    EXPECT_THAT(line["parameters"]["missing"], ElementsAre(0, -9999));
  }
}

TEST_F(Config, MayHoldInputAndOutputCountedFromItsFolder) {
  const std::string config = folder_.write_text(
      "settings/takes.toml", "input = [\"../in\"]\noutput = \"../out\"\nmethod = \"median\"\n");

  const Outcome outcome = run({"denoise", "--config", config});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_recording(folder_ / "out/runs/c.csv").frames(), 62);
}

TEST_F(Config, AFolderWithoutTakesIsAWarning) {
  const Outcome outcome =
      denoise("method = \"median\"\n[[folder]]\npath = \"walk\"\nmethod = \"hampel\"\n");

  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("takes.toml:2: no take lies in the folder walk"));
}

TEST_F(Config, AllOrNothingNeedsOneSetting) {
  const Outcome outcome =
      denoise("all-or-nothing = true\n[[folder]]\npath = \"walks\"\nmethod = \"hampel\"\n");

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("settings of folders"));
}

struct WrongConfig {
  const char* name;
  const char* text;
  const char* message;
};

void PrintTo(const WrongConfig& wrong, std::ostream* out) { *out << wrong.name; }

class WrongConfigs : public Config, public ::testing::WithParamInterface<WrongConfig> {};

TEST_P(WrongConfigs, AreNamedByLineAndWriteNothing) {
  const Outcome outcome = denoise(GetParam().text);

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, AllOf(StartsWith("moclean: " + folder_ / "takes.toml:"),
                                 HasSubstr(GetParam().message)));
  EXPECT_THAT(files_below(folder_, "out"), ElementsAre());
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, WrongConfigs,
    ::testing::Values(
        WrongConfig{
            "Key", "jobs = 1\nmetod = \"median\"\n",
            "toml:2: unknown key 'metod', expected the name of an option of moclean denoise "
            "without its dashes; did you mean 'method'?"},
        WrongConfig{"Dashes", "\"--method\" = \"median\"\n", "toml:1: unknown key '--method'"},
        WrongConfig{
            "FolderKey", "[[folder]]\npath = \"a\"\nmax-gp = 1\n",
            "toml:3: unknown key 'max-gp', expected the name of an option of moclean denoise "
            "without its dashes; did you mean 'max-gap'?"},
        WrongConfig{"OnlyForAll", "[[folder]]\npath = \"a\"\njobs = 1\n",
                    "toml:3: jobs is for all takes and cannot be set for a folder"},
        WrongConfig{"Value", "\njobs = 0\n", "toml:2: --jobs: must be positive, found '0'"},
        WrongConfig{"Method", "method = \"medan\"\n", "toml:1: unknown "},
        WrongConfig{"MethodKey", "method = \"median:width=3\"\n",
                    "toml:1: method median: unknown key"},
        WrongConfig{"Frames", "frames = \"9-5\"\n", "toml:1: --frames is '9-5'"},
        WrongConfig{"FlagText", "verify = \"yes\"\n", "toml:1: verify: expected true or false"},
        WrongConfig{"ValueFlag", "method = true\n", "toml:1: method: expected a value"},
        WrongConfig{"List", "method = [\"median\", \"hampel\"]\n", "toml:1: method: expected one"},
        WrongConfig{"Table", "[method]\nname = 1\n", "toml:1: method: expected a text or a number"},
        WrongConfig{"NoPath", "[[folder]]\nmethod = \"median\"\n", "toml:1: [[folder]]: expected"},
        WrongConfig{"AbsolutePath", "[[folder]]\npath = \"/a\"\n", "toml:2: path: expected a path"},
        WrongConfig{"OneFolder", "[folder]\npath = \"a\"\n", "toml:1: folder: expected tables"},
        WrongConfig{"NoToml", "method = median\n", "takes.toml:1: "}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace moclean::test
