// moclean denoise --resume: what is done is left out, and a run that was killed ends as if it had
// not been.

#include <array>

#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include "moclean/core/random.hpp"
#include "moclean/formats/read_write.hpp"

#include "cli/batch_folder.hpp"

namespace moclean::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Resume : public ::testing::Test {
 protected:
  Outcome denoise(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {folder_ / "in", "-o", folder_ / "out", "--lines", "-"});
    return denoise_quickly(more);
  }

  // The takes that a run has done.
  std::vector<std::string> done(const Outcome& outcome) const {
    std::vector<std::string> names;
    for (const nlohmann::json& line : lines_of(outcome.out))
      if (line.contains("outputs"))
        names.push_back(fs::path(line["file"].get<std::string>()).filename());
    std::ranges::sort(names);
    return names;
  }

  // After a whole run over three takes.
  void run_first() {
    for (int i = 0; i < 3; ++i) folder_.write(fmt::format("in/{}.csv", i), small_walk(30 + i));
    ASSERT_THAT(done(denoise({"--resume"})), ElementsAre("0.csv", "1.csv", "2.csv"));
  }

  TemporaryFolder folder_;
};

TEST_F(Resume, LeavesOutWhatIsDone) {
  run_first();
  const auto before = contents_below(folder_, "out");

  const Outcome again = denoise({"--resume"});

  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(done(again), IsEmpty());
  EXPECT_EQ(lines_of(again.out)[0]["left_out"], "done before");
  EXPECT_EQ(contents_below(folder_, "out"), before);
  EXPECT_THAT(done(denoise()), ElementsAre("0.csv", "1.csv", "2.csv"));  // without --resume
}

TEST_F(Resume, KnowsNamesOfAnyBytes) {
  for (const char* name : {"in/a\xff.csv", "in/a\xfe.csv", "in/b\\xFF.csv", "in/b\xff/c.csv"}) {
    fs::create_directories(fs::path(folder_ / name).parent_path());
    folder_.write(name, small_walk(30));
  }
  ASSERT_EQ(denoise({"--resume"}).exit_code, 0);
  const auto before = contents_below(folder_, "out");

  const Outcome again = denoise({"--resume"});

  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(done(again), IsEmpty());
  EXPECT_EQ(contents_below(folder_, "out"), before);
}

TEST_F(Resume, DoesAgainWhatIsMissingOrChanged) {
  run_first();
  fs::remove(folder_ / "out/0.csv");
  EXPECT_THAT(done(denoise({"--resume"})), ElementsAre("0.csv"));

  folder_.write_text("out/1.csv", "changed");
  EXPECT_THAT(done(denoise({"--resume"})), ElementsAre("1.csv"));

  folder_.write("in/2.csv", small_walk(40));
  EXPECT_THAT(done(denoise({"--resume"})), ElementsAre("2.csv"));
  EXPECT_EQ(read_recording(folder_ / "out/2.csv").frames(), 40);

  folder_.write("in/3.csv", small_walk(41));
  EXPECT_THAT(done(denoise({"--resume"})), ElementsAre("3.csv"));
}

TEST_F(Resume, DoesAllAgainWithOtherParametersButNotWithOtherJobs) {
  run_first();

  for (const std::vector<std::string>& same :
       {std::vector<std::string>{"--jobs", "1"}, {"--memory-limit", "64M"}, {"--no-overlap"}}) {
    std::vector<std::string> options = same;
    options.emplace_back("--resume");
    EXPECT_THAT(done(denoise(options)), IsEmpty()) << same[0];
  }
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"--method", "median:window=5"},
        {"--frames", "0:20"},
        {"--max-gap", "0.1"},
        {"--missing", "0"},
        {"--layout", "plain"},
        {"--keep-observed"},
        {"--mask", folder_ / "masks"}}) {
    std::vector<std::string> options = other;
    options.emplace_back("--resume");
    EXPECT_EQ(done(denoise(options)).size(), 3u) << other[0];
    EXPECT_THAT(done(denoise(options)), IsEmpty()) << other[0];
  }
}

TEST_F(Resume, TriesWhatFailedAgain) {
  folder_.write("in/a.csv", small_walk(30));
  folder_.write_text("in/b.csv", "a\nx\n");
  EXPECT_EQ(denoise().exit_code, 1);

  folder_.write("in/b.csv", small_walk(31));
  const Outcome again = denoise({"--resume"});

  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(done(again), ElementsAre("b.csv"));
}

TEST_F(Resume, KnowsAResultThatReplacedItsInput) {
  folder_.write("in/a.csv", small_walk(30));
  const std::vector<std::string> arguments = {folder_ / "in", "-o", folder_ / "in", "--force",
                                              "--lines",      "-",  "--resume"};
  ASSERT_THAT(done(denoise_quickly(arguments)), ElementsAre("a.csv"));
  const std::string once = content(folder_ / "in/a.csv");

  EXPECT_THAT(done(denoise_quickly(arguments)), IsEmpty());
  EXPECT_EQ(content(folder_ / "in/a.csv"), once);
}

TEST_F(Resume, IsForFoldersOfResults) {
  const std::string walk = folder_.write("walk.csv", small_walk(30));

  const Outcome outcome = denoise_quickly({walk, "-o", folder_ / "clean.csv", "--resume"});

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--resume needs a folder"));
}

TEST_F(Resume, SurvivesAManifestThatIsDamaged) {
  run_first();
  const std::string manifest = content(folder_ / "out/moclean.manifest.jsonl");
  for (const std::string& text :
       {std::string("no JSON\n{}\n[1]\n{\"output\":1}\n"), manifest.substr(0, manifest.size() - 9),
        std::string("\xff\xfe\n")}) {
    folder_.write_text("out/moclean.manifest.jsonl", text);

    EXPECT_EQ(denoise({"--resume"}).exit_code, 0);

    EXPECT_EQ(content(folder_ / "out/moclean.manifest.jsonl"), manifest);
  }
}

TEST_F(Resume, RemovesWhatAKilledRunHasLeftAndNothingElse) {
  run_first();
  folder_.write_text("out/.0.csv.0123456789abcdef01234567.tmp", "half");
  const std::vector<std::string> others = {".0.csv.tmp", ".9.csv.0123456789abcdef01234567.tmp",
                                           ".0.csv.0123456789abcdef0123456g.tmp", ".hidden"};
  for (const std::string& name : others) folder_.write_text("out/" + name, "of somebody else");

  ASSERT_EQ(denoise({"--resume"}).exit_code, 0);

  std::vector<std::string> left = files_below(folder_, "out");
  EXPECT_THAT(left, ::testing::Not(::testing::Contains(".0.csv.0123456789abcdef01234567.tmp")));
  for (const std::string& name : others) EXPECT_THAT(left, ::testing::Contains(name));
}

// Runs that are killed after random times, until one ends.
int kill_and_resume(const std::vector<std::string>& arguments, int kills, Random& random) {
  int killed = 0;
  while (killed < kills) {
    Program program(arguments);
    usleep(static_cast<useconds_t>(1000 + 40'000 * random.uniform()));
    program.send(SIGKILL);
    if (program.wait().exit_code == -SIGKILL) ++killed;
  }
  return run(arguments).exit_code;
}

TEST_F(Resume, KilledTwentyTimesGivesTheSameBytes) {
  const std::array kinds = {"csv", "npy", "trc", "c3d", "bvh"};
  for (int i = 0; i < 60; ++i) {
    const std::string kind = kinds[static_cast<std::size_t>(i) % kinds.size()],
                      name = fmt::format("in/{}/take{:02}.{}", i % 3, i, kind);
    if (kind == "bvh")
      folder_.write_text(name, std::string(tiny_bvh));
    else
      folder_.write(name, small_walk(200 + i, static_cast<std::uint64_t>(i + 1)));
  }
  folder_.write_text("in/bad.csv", "a\nx\n");
  const auto arguments = [&](const std::string& out) {
    return std::vector<std::string>{"denoise",
                                    folder_ / "in",
                                    "-o",
                                    folder_ / out,
                                    "--keep-raw",
                                    "--mask",
                                    folder_ / (out + "/masks"),
                                    "--method",
                                    "median",
                                    "--jobs",
                                    "1",
                                    "--resume",
                                    "--quiet"};
  };
  ASSERT_EQ(run(arguments("whole")).exit_code, 1);
  Random random(7);

  EXPECT_EQ(kill_and_resume(arguments("killed"), 20, random), 1);

  const auto whole = contents_below(folder_, "whole");
  EXPECT_EQ(whole.size(), 60u * 3 + 1);  // the manifest, too
  EXPECT_TRUE(contents_below(folder_, "killed") == whole);
}

TEST_F(Resume, KilledInPlaceLosesNoInputAndCleansNoneTwice) {
  for (int i = 0; i < 30; ++i)
    folder_.write(fmt::format("in/take{:02}.npy", i),
                  small_walk(200 + i, static_cast<std::uint64_t>(i + 1)));
  fs::copy(folder_ / "in", folder_ / "kept");
  fs::copy(folder_ / "in", folder_ / "forced");
  ASSERT_EQ(denoise_quickly({folder_ / "in", "-o", folder_ / "out"}).exit_code, 0);
  Random random(8);

  for (const auto& [name, option] : {std::pair{"kept", "--keep-raw"}, {"forced", "--force"}})
    EXPECT_EQ(kill_and_resume({"denoise", folder_ / name, "-o", folder_ / name, option, "--method",
                               "median", "--resume", "--quiet", "--jobs", "1"},
                              10, random),
              0);

  for (int i = 0; i < 30; ++i) {
    const std::string take = fmt::format("/take{:02}", i);
    const std::string clean = content(folder_ / ("out" + take + ".npy"));
    EXPECT_TRUE(content(folder_ / ("kept" + take + ".npy")) == clean) << i;
    EXPECT_TRUE(content(folder_ / ("forced" + take + ".npy")) == clean) << i;
    EXPECT_TRUE(content(folder_ / ("kept" + take + ".raw.npy")) ==
                content(folder_ / ("in" + take + ".npy")))
        << i;
  }
}

}  // namespace
}  // namespace moclean::test
