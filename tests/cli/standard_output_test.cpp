// What becomes of a command whose standard output takes nothing.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/batch_folder.hpp"

namespace moclean::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class StandardOutput : public ::testing::Test {
 protected:
  // Every command that prints, and every way to.
  std::vector<std::vector<std::string>> commands() const {
    const std::string result = folder_ / "result.csv";
    return {
        {"info", walk_},
        {"info", walk_, "--json"},
        {"convert", walk_, result},
        {"corrupt", walk_, "-o", result, "--noise", "gaussian:sd=1"},
        {"evaluate", walk_, walk_},
        {"evaluate", walk_, walk_, "--json"},
        {"devices", "--json"},
        {"denoise", walk_, "-o", result, "--method", "median"},
        {"denoise", walk_, "-o", result, "--method", "median", "--json", "-"},
        {"denoise", walk_, "-o", result, "--method", "median", "--lines", "-"},
        {"denoise", walk_, "-o", "-", "--method", "median", "--format", "csv"},
        {"denoise", walk_, "-o", result, "--method", "median", "--dry-run"},
        {"experiment", "table3", walk_, "--seeds", "1", "--backend", "reference"},
        {"experiment", "table3", walk_, "--seeds", "1", "--backend", "reference", "--json", "-"},
        {"--help"},
        {"denoise", "--help"},
        {"--version"}};
  }

  TemporaryFolder folder_;
  std::string walk_ = folder_.write("walk.csv", small_walk(30));
};

TEST_F(StandardOutput, ThatIsFullIsAFailureOfEveryCommand) {
  for (const auto& command : commands()) {
    const Outcome outcome = run(command, {.device = "", .output = "/dev/full"});

    EXPECT_EQ(outcome.exit_code, 1) << ::testing::PrintToString(command);
    EXPECT_THAT(outcome.err, HasSubstr("moclean: standard output: cannot be written: "))
        << ::testing::PrintToString(command);
  }
}

// The result must not be opened as standard output and be printed into.
TEST_F(StandardOutput, ThatIsClosedGetsNothingIntoAResult) {
  const Outcome outcome =
      run({"convert", walk_, folder_ / "copy.csv"}, {.device = "", .output = "-"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("standard output: cannot be written"));
  EXPECT_EQ(content(folder_ / "copy.csv"), content(walk_));
}

// As `moclean denoise ... --lines - | head -1`: who reads has enough, the takes are done all the
// same.
TEST_F(StandardOutput, WhoseReaderHasGoneEndsTheProgramInTheEndWithoutAWord) {
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  Program program({"denoise", walk_, "-o", folder_ / "result.csv", "--method", "median", "--quiet",
                   "--lines", "-"},
                  {.device = "", .output = pipe});
  close(reader);

  const Outcome outcome = program.wait();

  EXPECT_EQ(outcome.exit_code, -SIGPIPE);
  EXPECT_THAT(outcome.err, Not(HasSubstr("standard output")));
  EXPECT_THAT(folder_.names(), ::testing::ElementsAre("pipe", "result.csv", "walk.csv"));
}

}  // namespace
}  // namespace moclean::test
