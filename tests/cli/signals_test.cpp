// Signals while a command reads or writes: the program ends at once, and nothing of it is left.

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "moclean/core/random.hpp"

#include "cli/batch_folder.hpp"

namespace moclean::test {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Signals : public ::testing::TestWithParam<int> {
 protected:
  std::string pipe(const std::string& name) const {
    EXPECT_EQ(mkfifo((folder_ / name).c_str(), 0600), 0);
    return folder_ / name;
  }

  // What a run does that got the signal while it waited, and is ended after a while if it still
  // waits.
  Outcome interrupted(const std::vector<std::string>& command) const {
    Program program(command);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    program.send(GetParam());
    std::jthread in_the_end([&](const std::stop_token& done) {
      for (int i = 0; i < 1000 && !done.stop_requested(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      if (!done.stop_requested()) program.send(SIGKILL);
    });
    return program.wait();
  }

  TemporaryFolder folder_;
  std::string walk_ = folder_.write("walk.csv", small_walk(30));
};

TEST_P(Signals, EndACommandThatWaitsForItsInput) {
  const std::string in = pipe("in.csv"), out = folder_ / "out.csv";
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"info", in},
           {"convert", in, out},
           {"corrupt", in, "-o", out, "--noise", "gaussian:sd=1"},
           {"evaluate", in, walk_},
           {"evaluate", walk_, in},
           {"denoise", in, "-o", out, "--method", "median"},
           {"denoise", walk_, in, "-o", folder_ / "out", "--method", "median"},
           {"denoise", walk_, "-o", out, "--method", "median", "--truth", in},
           {"denoise", walk_, "-o", out, "--config", in},
           {"experiment", "grid", in, "-o", folder_ / "out"}}) {
    const Outcome outcome = interrupted(command);

    EXPECT_EQ(outcome.exit_code, 130) << ::testing::PrintToString(command);
    EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
    std::filesystem::remove_all(folder_ / "out");  // where a take was done before
    EXPECT_THAT(folder_.names(), ElementsAre("in.csv", "walk.csv"));
  }
}

TEST_P(Signals, RemoveWhatACommandHasNotFinished) {
  const std::string mask = pipe("mask.csv");  // nobody reads it, and the result waits for it

  const Outcome outcome = interrupted(
      {"corrupt", walk_, "-o", folder_ / "out.csv", "--noise", "gaussian:sd=1", "--mask", mask});

  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_THAT(folder_.names(), ElementsAre("mask.csv", "walk.csv"));
}

INSTANTIATE_TEST_SUITE_P(Each, Signals, ::testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT),
                         [](const auto& test) { return std::string(sigabbrev_np(test.param)); });

class AfterAKill : public Signals {};

TEST_P(AfterAKill, TheNextRunIntoTheFolderRemovesWhatIsLeft) {
  const std::string mask = pipe("mask.csv");
  const std::vector<std::string> corrupt = {
      "corrupt", walk_, "-o", folder_ / "out.csv", "--noise", "gaussian:sd=1", "--mask", mask};
  ASSERT_EQ(interrupted(corrupt).exit_code, -SIGKILL);
  ASSERT_EQ(folder_.names().size(), 3u) << "a temporary file";
  std::filesystem::remove(mask);

  EXPECT_EQ(run({"convert", walk_, folder_ / "other.npy"}).exit_code, 0);

  EXPECT_THAT(folder_.names(), ElementsAre("other.npy", "walk.csv"));
}

INSTANTIATE_TEST_SUITE_P(By, AfterAKill, ::testing::Values(SIGKILL),
                         [](const auto&) { return "Kill"; });

TEST(FileSizeLimit, IsAnErrorAndLeavesNothing) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.npy", small_walk(2000));
  rlimit before{}, small{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  small = {.rlim_cur = 4096, .rlim_max = before.rlim_max};

  setrlimit(RLIMIT_FSIZE, &small);
  Program program({"convert", walk, folder / "copy.npy"});
  setrlimit(RLIMIT_FSIZE, &before);
  const Outcome outcome = program.wait();

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("copy.npy: cannot be written: File too large"));
  EXPECT_THAT(folder.names(), ElementsAre("walk.npy"));
}

// Signals at moments spread over a run: what stands under its name is whole, nothing unfinished is
// left by those that can be caught nor after the next run, which ends as an undisturbed one.
// MOCLEAN_MOMENTS=20 is what a release tries.
TEST(SignalsAtAnyMoment, CostAFolderRunNothing) {
  const TemporaryFolder folder;
  for (int i = 0; i < 24; ++i)
    folder.write(fmt::format("in/{}/take{:02}.npy", i % 3, i),
                 small_walk(100 + i, static_cast<std::uint64_t>(i + 1)));
  const auto command = [&](const std::string& out) {
    return std::vector<std::string>{
        "denoise",  folder / "in", "-o", folder / out, "--method",
        "median",   "--jobs",      "1",  "--mask",     folder / (out + "/masks"),
        "--resume", "--quiet"};
  };
  ASSERT_EQ(run(command("whole")).exit_code, 0);
  const auto whole = contents_below(folder, "whole");
  const char* wanted = std::getenv("MOCLEAN_MOMENTS");
  const int moments = wanted ? std::atoi(wanted) : 3;
  Random random(11);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGKILL, SIGXFSZ})
    for (int moment = 0; moment < moments; ++moment) {
      SCOPED_TRACE(fmt::format("signal {}, moment {}", signal, moment));
      Program program(command("out"));
      std::this_thread::sleep_for(std::chrono::microseconds(
          static_cast<int>(120'000 * (moment + random.uniform())) / moments));
      program.send(signal);
      const int exit_code = program.wait().exit_code;

      // before the program has begun, and of what cannot be caught, the system has the say
      EXPECT_THAT(exit_code, AnyOf(0, 130, -signal));
      for (const auto& [name, bytes] : contents_below(folder, "out")) {
        if (signal != SIGKILL) {
          EXPECT_FALSE(name.ends_with(".tmp")) << name;
        }
        if (name.ends_with(".npy")) {
          EXPECT_TRUE(std::ranges::find(whole, std::pair(name, bytes)) != whole.end()) << name;
        }
      }
      EXPECT_EQ(run(command("out")).exit_code, 0);
      EXPECT_TRUE(contents_below(folder, "out") == whole);
      std::filesystem::remove_all(folder / "out");
    }
}

}  // namespace
}  // namespace moclean::test
