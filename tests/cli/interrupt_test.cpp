// Signals, and what is shown on a terminal: both need a run that takes a while.

#include <algorithm>

#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include "cli/program.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// A run of the reference that shows its progress: many small segments, so that one is soon done
// also under sanitizers; 10 s where it is stopped, a second where not. Segments of 40 frames change
// much of a walk, which the program says; those of 200 do not.
std::vector<std::string> long_run(const TemporaryFolder& folder, Index frames,
                                  const std::string& segment_length = "40") {
  return {"denoise",
          folder.write("walk.npy", synthetic_walk(frames)),
          "-o",
          folder / "clean.npy",
          "--json",
          folder / "record.json",
          "--method",
          "slra",
          "--segment-length",
          segment_length,
          "--backend",
          "reference",
          "--jobs",
          "1"};
}

class Interrupted : public ::testing::TestWithParam<int> {};

TEST_P(Interrupted, StopsWithoutAnyOutput) {
  const TemporaryFolder folder;
  Program program(long_run(folder, 20000), {.device = "", .terminal = true});
  ASSERT_TRUE(program.shows("of 500 segments"));

  program.send(GetParam());
  const Outcome outcome = program.wait();

  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(folder.names(), ElementsAre("walk.npy"));
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupted, ::testing::Values(SIGINT, SIGTERM),
                         [](const auto& test) {
                           return test.param == SIGINT ? "Interrupt" : "Terminate";
                         });

TEST(Interrupt, StopsTheDevice) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.npy", synthetic_walk(20000));
  Program program({"denoise", walk, "-o", folder / "clean.npy"}, {.device = "", .terminal = true});
  ASSERT_TRUE(program.shows("solving"));

  program.send(SIGINT);

  EXPECT_EQ(program.wait().exit_code, 130);
  EXPECT_THAT(folder.names(), ElementsAre("walk.npy"));
}

TEST(Interrupt, LeavesAnEarlierResultAsItWas) {
  const TemporaryFolder folder;
  const std::string earlier = folder.write_text("clean.npy", "earlier");
  Program program(long_run(folder, 20000), {.device = "", .terminal = true});
  ASSERT_TRUE(program.shows("of 500 segments"));

  program.send(SIGINT);

  EXPECT_EQ(program.wait().exit_code, 130);
  EXPECT_EQ(content(earlier), "earlier");
}

// The takes of a batch each; one more is solved when one is written.
class InterruptedBatch : public ::testing::Test {
 protected:
  std::vector<std::string> arguments(const std::string& option) {
    for (const char* name : {"takes/a.npy", "takes/b.npy", "takes/c.npy"})
      folder_.write(name, synthetic_walk(1000));
    return {
        "denoise",   folder_ / "takes", "-o", folder_ / "clean", "--method", "slra", "--backend",
        "reference", "--jobs",          "1",  "--memory-limit",  "11M",      option};
  }

  bool has(const std::string& ending) const {
    return std::ranges::any_of(folder_.names(), [&](const std::string& name) {
      return name.starts_with("clean/") && name.ends_with(ending);
    });
  }

  TemporaryFolder folder_;
};

TEST_F(InterruptedBatch, KeepsWhatIsWrittenAndSaysHowToGoOn) {
  Program program(arguments("--resume"), {.device = "", .terminal = true});
  ASSERT_TRUE(program.shows("5 of about 15 segments"));
  while (!has("a.npy")) usleep(1000);

  program.send(SIGINT);
  const Outcome outcome = program.wait();

  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_THAT(outcome.err, HasSubstr(" of 3 takes were written and stay, --resume goes on"));
  EXPECT_TRUE(has("a.npy"));
  EXPECT_FALSE(has(".tmp"));
  EXPECT_FALSE(has("c.npy"));
}

TEST_F(InterruptedBatch, RemovesTheResultsThatWaitForTheOthers) {
  Program program(arguments("--all-or-nothing"), {.device = "", .terminal = true});
  ASSERT_TRUE(program.shows("5 of about 15 segments"));
  while (!has(".tmp")) usleep(1000);

  program.send(SIGINT);

  EXPECT_EQ(program.wait().exit_code, 130);
  EXPECT_THAT(folder_.names(), ElementsAre("takes", "takes/a.npy", "takes/b.npy", "takes/c.npy"));
}

TEST(Interrupt, KilledRunLeavesNoHalfFile) {
  const TemporaryFolder folder;
  Program program(long_run(folder, 20000), {.device = "", .terminal = true});
  ASSERT_TRUE(program.shows("of 500 segments"));

  program.send(SIGKILL);

  EXPECT_EQ(program.wait().exit_code, -SIGKILL);
  EXPECT_THAT(folder.names(), ElementsAre("walk.npy"));
}

TEST(Interrupt, IsIgnoredWhereItWasIgnoredBefore) {
  const TemporaryFolder folder;
  Program program(long_run(folder, 2000),
                  {.device = "", .terminal = true, .ignore_interrupt = true});
  ASSERT_TRUE(program.shows("of 50 segments"));

  program.send(SIGINT);

  EXPECT_EQ(program.wait().exit_code, 0);
  EXPECT_THAT(folder.names(), ElementsAre("clean.npy", "record.json", "walk.npy"));
}

TEST(Progress, IsShownOnATerminalAndClearedAtTheEnd) {
  const TemporaryFolder folder;
  Program program(long_run(folder, 1600, "200"), {.device = "", .terminal = true});

  EXPECT_TRUE(program.shows("s left"));

  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, ::testing::EndsWith("\r\033[K"));
}

TEST(Progress, SaysThatKernelsAreCompiledOnTheFirstUseOfADevice) {
  if (run({"devices", "--json"}).json().empty()) GTEST_SKIP() << "no OpenCL device";
  const TemporaryFolder folder;
  const std::vector<std::string> arguments = {
      "denoise",  folder.write("walk.npy", synthetic_walk(100)),
      "-o",       folder / "clean.npy",
      "--method", "tsvd"};
  const Start fresh{.device = "", .cache = folder / "cache", .terminal = true};

  Program first(arguments, fresh);
  EXPECT_TRUE(first.shows("solving: compiling kernels, first use on this device ..."));
  EXPECT_EQ(first.wait().exit_code, 0);

  EXPECT_THAT(run(arguments, fresh).err, Not(HasSubstr("compiling")));
}

TEST(Progress, IsAbsentFromAFileAndWithQuiet) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = long_run(folder, 200, "200");

  const Outcome to_file = run(arguments);
  arguments.push_back("--quiet");
  Program quiet(arguments, {.device = "", .terminal = true});
  const Outcome quiet_outcome = quiet.wait();

  EXPECT_EQ(to_file.exit_code, 0);
  EXPECT_THAT(to_file.err, IsEmpty());
  EXPECT_THAT(to_file.out, Not(IsEmpty()));
  EXPECT_THAT(quiet_outcome.err, IsEmpty());
  EXPECT_THAT(quiet_outcome.out, IsEmpty());
}

}  // namespace
}  // namespace moclean::test
