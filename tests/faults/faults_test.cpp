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
#include "faults/fault_table.hpp"

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
            "--all-or-nothing"}},
          {"Info", {"info", "@in/a.csv"}}};
}

using Results = std::vector<std::pair<std::string, std::string>>;

FaultTable table;

class Faults : public ::testing::TestWithParam<Work> {
 protected:
  static void TearDownTestSuite() { table.print("of the system"); }

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
    Program program(command(),
                    {.environment = {"LD_PRELOAD=" MOCLEAN_FAULTS_LIBRARY, "MOCLEAN_FAULT=" + fault,
                                     "MOCLEAN_FAULT_CALLS=" + (folder_ / "calls")}});
    // The first run on a device compiles its kernels.
    const bool only_counts = fault.find(':') == std::string::npos;
    return program.wait_at_most(std::chrono::seconds(only_counts ? 300 : 20));
  }

  // How often an undisturbed run calls a function.
  long calls_of(const std::string& function) {
    prepare();
    EXPECT_EQ(run_with(function).exit_code, 0);
    return std::atol(content(folder_ / "calls").c_str());
  }

  // All that a run makes or replaces.
  Results results() const {
    auto all = contents_below(folder_, "out");
    all.emplace_back("copy.csv", content(folder_ / "copy.csv"));
    return all;
  }

  // Calls of a function fail, every n-th in turn, so that the test stays short. `how` follows the
  // number: `+` from then on, `:interrupted`.
  void expect_survival(const std::string& function, long tried, const std::string& how = "") {
    const long calls = calls_of(function);
    const auto whole = results();
    const char* all = std::getenv("MOCLEAN_FAULTS");
    const long step = all && std::string_view(all) == "all" ? 1 : std::max(1L, calls / tried);
    FaultTable::Row& row = table[function + how];
    row.calls += calls;
    for (long n = 1; n <= calls; n += step) {
      SCOPED_TRACE(fmt::format("call {}{} of {} of {}()", n, how, calls, function));
      ++row.injected;
      const bool told = fail_once(fmt::format("{}:{}{}", function, n, how), whole);
      ++(told ? row.told : row.harmless);
    }
  }

  // Whether the program ended with an error; it has to leave nothing half, and the next run ends as
  // if nothing had been.
  bool fail_once(const std::string& fault, const Results& whole) {
    prepare();
    const auto before = results();

    const Outcome outcome = run_with(fault);

    EXPECT_THAT(outcome.exit_code, AnyOf(0, 1)) << outcome.err;
    if (outcome.exit_code != 0 && !fault.starts_with("write:")) {  // the message is written, too
      EXPECT_THAT(outcome.err, ::testing::HasSubstr("moclean: "));
    }
    const bool may_litter = fault.starts_with("remove:") || fault.starts_with("unlinkat:");
    for (const auto& [name, bytes] : results()) {
      if (name.ends_with(".tmp")) {
        EXPECT_TRUE(may_litter) << name;
        continue;
      }
      const bool is_whole = std::ranges::find(whole, std::pair(name, bytes)) != whole.end(),
                 is_old = std::ranges::find(before, std::pair(name, bytes)) != before.end();
      if (!name.ends_with(".jsonl")) {
        EXPECT_TRUE(is_whole || is_old) << name << " is half";
      }
    }
    if (outcome.exit_code == 0) {
      for (const auto& [name, bytes] : whole)
        if (!name.ends_with(".jsonl")) {
          EXPECT_EQ(content(folder_ / name_in_folder(name)), bytes) << name << " is missing";
        }
      return false;
    }
    folder_.write("copy.csv", small_walk(12));
    EXPECT_EQ(run(command()).exit_code, 0);
    EXPECT_TRUE(results() == whole) << "the next run differs";
    return true;
  }

  static std::string name_in_folder(const std::string& name) {
    return name == "copy.csv" ? name : "out/" + name;
  }

  void SetUp() override {
    folder_.write("in/a.csv", small_walk(30));
    folder_.write("in/b.npy", small_walk(31));
  }

  TemporaryFolder folder_;
};

TEST_P(Faults, OfFilesAreSurvived) {
  for (const char* function : {"open", "read", "write", "close", "rename"}) {
    expect_survival(function, 20);
    if (GetParam().name != "Info") {
      EXPECT_GT(table[function].told, 0) << function << " never mattered";
    }
    expect_survival(function, 4, "+");
    expect_survival(function, 4, ":interrupted");
  }
  expect_survival("write", 10, ":short");
}

TEST_P(Faults, OfTheDiskAreSurvivedWhereAFileIsReplaced) {
  if (GetParam().name != "Replace") GTEST_SKIP() << "replaces nothing";
  expect_survival("fsync", 40);
  EXPECT_GT(table["fsync"].told, 0);
}

TEST_P(Faults, OfFoldersAndNamesAreSurvived) {
  for (const char* function : {"stat", "fstat", "mkdir", "readdir", "openat", "remove", "unlinkat",
                               "truncate", "lseek", "fchmod", "fchown", "flock", "writev"}) {
    expect_survival(function, 5);
    expect_survival(function, 2, "+");
  }
}

TEST_P(Faults, OfMemoryAndThreadsAreSurvived) {
  expect_survival("malloc", 20);
  EXPECT_GT(table["malloc"].told, 0);
  expect_survival("malloc", 8, "+");  // it hung where nothing had been made before
  for (const char* function : {"realloc", "calloc", "aligned_alloc", "pthread_create"}) {
    expect_survival(function, 5);
    expect_survival(function, 2, "+");
  }
}

class FaultsOnADevice : public Faults {};

// That of a driver and its compiler.
TEST_P(FaultsOnADevice, OfMappedMemoryAreSurvived) {
  if (run({"devices", "--json"}).json().empty()) GTEST_SKIP() << "no OpenCL device";
  for (const char* function : {"mmap", "munmap"}) {
    expect_survival(function, 4);
    expect_survival(function, 2, "+");
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Faults, ::testing::ValuesIn(works()),
                         [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Of, FaultsOnADevice,
    ::testing::Values(Work{"Denoise", {"denoise", "@in", "-o", "@out/clean", "--method", "tsvd"}}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace moclean::test
