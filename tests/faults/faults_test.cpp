// One call of the system or one allocation fails, in a small run of each command: the program ends
// with a message, leaves no half file, and the next run ends as if nothing had been.
//
// MOCLEAN_FAULTS=all tries every allocation; otherwise some, spread over the run.

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>

#include "cli/batch_folder.hpp"

namespace moclean::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::Not;

// A command on files of a folder, and what it is to make there.
struct Work {
  std::string name;
  std::vector<std::string> command;  // `@` begins a path in the folder
};

std::vector<Work> works() {
  return {{"Convert", {"convert", "@in/a.csv", "@out/a.npy"}},
          {"Replace", {"convert", "@copy.csv", "@copy.csv", "--force", "--frames", "0:9"}},
          {"Corrupt",
           {"corrupt", "@in/a.csv", "-o", "@out/a.csv", "--noise", "gaussian:sd=1", "--mask",
            "@out/mask.csv"}},
          {"Denoise",
           {"denoise", "@in", "-o", "@out/clean", "--method", "median", "--jobs", "1", "--mask",
            "@out/masks", "--resume"}},
          {"AllOrNothing",
           {"denoise", "@in", "-o", "@out/clean", "--method", "median", "--jobs", "1",
            "--all-or-nothing"}}};
}

class Faults : public ::testing::TestWithParam<Work> {
 protected:
  void prepare() {
    fs::remove_all(folder_ / "out");
    fs::create_directory(folder_ / "out");
    folder_.write("copy.csv", small_walk(12));
  }

  std::vector<std::string> command() const {
    std::vector<std::string> arguments = GetParam().command;
    for (std::string& argument : arguments)
      if (argument.starts_with('@')) argument = folder_ / argument.substr(1);
    return arguments;
  }

  Outcome run_with(const std::string& fault) const {
    return run(command(),
               {.environment = {"LD_PRELOAD=" MOCLEAN_FAULTS_LIBRARY, "MOCLEAN_FAULT=" + fault,
                                "MOCLEAN_FAULT_CALLS=" + (folder_ / "calls")}});
  }

  // How often an undisturbed run calls a function.
  long calls_of(const std::string& function) {
    prepare();
    EXPECT_EQ(run_with(function).exit_code, 0);
    return std::atol(content(folder_ / "calls").c_str());
  }

  // All that a run makes or replaces.
  std::vector<std::pair<std::string, std::string>> results() const {
    auto all = contents_below(folder_, "out");
    all.emplace_back("copy.csv", content(folder_ / "copy.csv"));
    return all;
  }

  // Every n-th call, so that the test stays short.
  void expect_survival(const std::string& function, long tried) {
    const long calls = calls_of(function);
    const auto whole = results();
    ASSERT_GT(calls, 0) << function;
    const char* all = std::getenv("MOCLEAN_FAULTS");
    const long step = all && std::string_view(all) == "all" ? 1 : std::max(1L, calls / tried);
    long failed = 0;
    for (long n = 1; n <= calls; n += step) {
      SCOPED_TRACE(fmt::format("call {} of {} of {}()", n, calls, function));
      prepare();
      const auto before = results();

      const Outcome outcome = run_with(fmt::format("{}:{}", function, n));

      ASSERT_THAT(outcome.exit_code, AnyOf(0, 1)) << outcome.err;
      if (outcome.exit_code != 0) {
        EXPECT_THAT(outcome.err, ::testing::StartsWith("moclean: "));
      }
      for (const auto& [name, bytes] : results()) {
        EXPECT_FALSE(name.ends_with(".tmp")) << name;
        const bool is_whole = std::ranges::find(whole, std::pair(name, bytes)) != whole.end(),
                   is_old = std::ranges::find(before, std::pair(name, bytes)) != before.end();
        if (!name.ends_with(".jsonl")) {
          EXPECT_TRUE(is_whole || is_old) << name << " is half";
        }
      }
      if (outcome.exit_code == 0) continue;
      ++failed;
      folder_.write("copy.csv", small_walk(12));
      EXPECT_EQ(run(command()).exit_code, 0);
      EXPECT_TRUE(results() == whole) << "the next run differs";
    }
    EXPECT_GT(failed, 0) << function << " never mattered";
  }

  void SetUp() override {
    folder_.write("in/a.csv", small_walk(30));
    folder_.write("in/b.npy", small_walk(31));
  }

  TemporaryFolder folder_;
};

TEST_P(Faults, OfFilesAreSurvived) {
  for (const char* function : {"open", "read", "write", "close", "rename"})
    expect_survival(function, 40);
}

TEST_P(Faults, OfTheDiskAreSurvivedWhereAFileIsReplaced) {
  if (GetParam().name != "Replace") GTEST_SKIP() << "replaces nothing";
  expect_survival("fsync", 40);
}

TEST_P(Faults, OfMemoryAreSurvived) { expect_survival("malloc", 25); }

INSTANTIATE_TEST_SUITE_P(Of, Faults, ::testing::ValuesIn(works()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace moclean::test
