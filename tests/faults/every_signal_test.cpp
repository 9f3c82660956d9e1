// Every command gets every signal at moments spread over its run, and limits for the size of files:
// it ends as it promises, what stands under its name is complete, and the next run ends as if
// nothing had been and leaves no litter.
//
// MOCLEAN_SIGNALS=all tries 20 moments and limits; otherwise a few.

#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <sys/resource.h>

#include "moclean/core/random.hpp"

#include "faults/interrupted_work.hpp"

namespace moclean::test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

const char* const grid = R"(seeds = 2
[[take]]
file = "in/a.csv"
[[noise]]
spec = "gaussian-frames:fraction=0.3"
label = "frames"
[[method]]
spec = "none"
[[method]]
spec = "median"
)";

std::vector<InterruptedWork> commands() {
  return {
      {"Convert", {"convert", "@long.csv", "@out/a.npy"}},
      {"Info", {"info", "@long.csv", "--json"}},
      {"Evaluate", {"evaluate", "@long.csv", "@long.csv"}},
      {"Corrupt",
       {"corrupt", "@long.csv", "-o", "@out/a.csv", "--noise", "gaussian:sd=1", "--mask",
        "@out/mask.csv"}},
      {"Denoise", {"denoise", "@in/a.csv", "-o", "@out/a.csv", "--mask", "@out/mask.csv"}},
      {"DenoiseOnTheDevice", {"denoise", "@in", "-o", "@out", "--method", "slra", "--resume"}},
      {"DenoiseAFolder",
       {"denoise", "@in", "-o", "@out/clean", "--method", "median", "--jobs", "1", "--mask",
        "@out/masks", "--resume"}},
      {"AllOrNothing",
       {"denoise", "@in", "-o", "@out/clean", "--method", "median", "--all-or-nothing"}},
      {"Report",
       {"denoise", "@in/a.csv", "-o", "@out/a.csv", "--method", "median", "--report", "@out/a.html",
        "--json", "@out/a.json"}},
      {"Experiment", {"experiment", "grid", "@grid.toml", "-o", "@out/grid", "--quiet"}},
      {"Tune", {"tune", "--quick", "--frames", "9", "--columns", "3", "--json", "@out/tune.json"}},
      {"Devices", {"devices"}}};
}

class EverySignal : public ::testing::TestWithParam<InterruptedWork> {
 protected:
  void SetUp() override {
    if (GetParam().name == "Tune" && !all_signals()) GTEST_SKIP() << "MOCLEAN_SIGNALS=all tries it";
    const TemporaryFolder& folder = workshop_.folder();
    for (int i = 0; i < 6; ++i)
      folder.write(fmt::format("in/{}.{}", "abcdef"[i], i % 2 == 0 ? "csv" : "npy"),
                   small_walk(60 + i, static_cast<std::uint64_t>(i + 1)));
    folder.write("long.csv", small_walk(4000));
    folder.write_text("grid.toml", grid);
    const Outcome outcome = workshop_.learn();
    if (outcome.err.find("no OpenCL device") != std::string::npos)
      GTEST_SKIP() << "no OpenCL device";
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  void send_at(int signal, double moment) {
    SCOPED_TRACE(fmt::format("signal {} after {:.0f} % of the time", signal, 100 * moment));
    workshop_.clear();
    Program program(workshop_.command(), workshop_.start());
    std::this_thread::sleep_for(moment * workshop_.duration());
    program.send(signal);

    const int exit_code = program.wait_at_most(patience()).exit_code;

    // before the program has begun, and of what cannot be caught, the system has the say
    EXPECT_THAT(exit_code, AnyOf(0, 130, -signal));
    EXPECT_EQ(workshop_.half_result(signal == SIGKILL), "");
    if (exit_code == 0) {
      EXPECT_EQ(workshop_.difference(), "");
    }
    expect_the_next_run_whole();
  }

  // A result that can not be written is an error, with what there is of other results complete.
  void limit_files(rlim_t bytes) {
    SCOPED_TRACE(fmt::format("files of {} bytes at most", bytes));
    workshop_.clear();
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit small{.rlim_cur = bytes, .rlim_max = before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    Program program(workshop_.command(), workshop_.start());
    setrlimit(RLIMIT_FSIZE, &before);

    const Outcome outcome = program.wait_at_most(patience());

    ASSERT_THAT(outcome.exit_code, AnyOf(0, 1)) << outcome.err;
    EXPECT_EQ(workshop_.half_result(false), "");
    if (outcome.exit_code == 0) {
      EXPECT_EQ(workshop_.difference(), "");
    } else {
      EXPECT_THAT(outcome.err, HasSubstr("moclean: "));  // a driver may speak, too
    }
    expect_the_next_run_whole();
  }

  // Where a signal does nothing the run takes its time.
  std::chrono::milliseconds patience() const {
    return std::chrono::seconds(20) +
           std::chrono::duration_cast<std::chrono::milliseconds>(3 * workshop_.duration());
  }

  void expect_the_next_run_whole() const {
    const Outcome next = Program(workshop_.command(), workshop_.start()).wait();
    EXPECT_EQ(next.exit_code, 0) << next.err;
    EXPECT_EQ(workshop_.difference(), "");
  }

  rlim_t largest_result() const {
    std::size_t largest = 0;
    for (const auto& [name, bytes] : workshop_.whole()) largest = std::max(largest, bytes.size());
    return largest;
  }

  Workshop workshop_{GetParam()};
  Random random_{17};
};

TEST_P(EverySignal, AtAnyMomentCostsNothing) {
  const int moments = all_signals() ? 20 : 2;
  int turn = static_cast<int>(GetParam().name.size());  // not the same signals for all
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGKILL, SIGXFSZ})
    for (int moment = 0; moment < moments; ++moment) {
      const double share = (moment + random_.uniform()) / moments;
      if (all_signals() || ++turn % 5 == 0) send_at(signal, share);
    }
}

TEST_P(EverySignal, IsNotNeededWhereFilesMayNotBeLarge) {
  if (largest_result() == 0) GTEST_SKIP() << "writes no file";
  const int limits = all_signals() ? 20 : 4;
  for (int i = 0; i < limits; ++i)
    limit_files(2048 + largest_result() * static_cast<rlim_t>(i) / static_cast<rlim_t>(limits));
}

INSTANTIATE_TEST_SUITE_P(To, EverySignal, ::testing::ValuesIn(commands()),
                         [](const auto& test) { return test.param.name; });

// LLVM, in a driver, has a handler that removes the files its compiler works on.
TEST(SizeSignals, DoNotReachADriver) {
  if (run({"devices", "--json"}).json().empty()) GTEST_SKIP() << "no OpenCL device";
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.csv", small_walk(30));
  const std::string cache = "POCL_CACHE_DIR=" + (folder / "kernels");  // so that it compiles
  Program program({"denoise", walk, "-o", folder / "clean.csv", "--method", "tsvd"},
                  {.environment = {cache}});
  std::this_thread::sleep_for(std::chrono::milliseconds(400));  // until it has begun
  for (int i = 0; i < 500; ++i) {
    program.send(SIGXFSZ);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  const Outcome outcome = program.wait_at_most(std::chrono::seconds(60));

  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

// Killed again and again, a run of a folder ends as one that was not.
TEST(ManyKills, OfAFolderRunCostNothing) {
  Workshop workshop({"Folder",
                     {"denoise", "@in", "-o", "@out/clean", "--method", "median+hampel", "--mask",
                      "@out/masks", "--resume"}});
  for (int i = 0; i < 40; ++i)
    workshop.folder().write(fmt::format("in/{}/take{:02}.{}", i % 4, i, i % 3 ? "csv" : "npy"),
                            small_walk(200 + i, static_cast<std::uint64_t>(i + 1)));
  ASSERT_EQ(workshop.learn().exit_code, 0);
  Random random(23);
  const int wanted = all_signals() ? 200 : 10;
  int rounds = 0;
  workshop.clear();
  for (int kills = 0; kills < wanted;) {
    Program program(workshop.command(), workshop.start());
    std::this_thread::sleep_for(random.uniform() * workshop.duration());
    program.send(SIGKILL);
    const Outcome outcome = program.wait();
    ASSERT_THAT(outcome.exit_code, AnyOf(0, -SIGKILL)) << outcome.err;
    ASSERT_EQ(workshop.half_result(true), "") << kills << " kills";
    if (outcome.exit_code != 0) {
      ++kills;
      continue;
    }
    ++rounds;
    EXPECT_EQ(workshop.difference(), "") << kills << " kills";
    workshop.clear();
  }
  EXPECT_EQ(Program(workshop.command(), workshop.start()).wait().exit_code, 0);
  EXPECT_EQ(workshop.difference(), "");
  fmt::print("{} kills, {} runs ended between them\n", wanted, rounds);
}

}  // namespace
}  // namespace moclean::test
