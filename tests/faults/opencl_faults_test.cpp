// The same for the program: a call of OpenCL fails while it cleans a take. It says so with the
// call's and the take's names, or ends as an undisturbed run; it leaves nothing half, does not
// hang, and the next run ends as if nothing had been.
//
// MOCLEAN_FAULTS=all tries 25 of every function in every work, spread over calls and errors (the
// library's test tries all); otherwise one of every tenth.

#include <algorithm>

#include <gmock/gmock.h>

#include "cli/batch_folder.hpp"
#include "faults/fault_table.hpp"
#include "faults/opencl_fault_list.hpp"

namespace moclean::test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

FaultTable program_table;

class OpenClFaults : public ::testing::TestWithParam<OpenClWork> {
 protected:
  static void TearDownTestSuite() { program_table.print("in the program"); }

  void SetUp() override {
    if (run({"devices", "--json"}).json().empty()) GTEST_SKIP() << "no OpenCL device";
    const std::string& name = GetParam().name;
    if (!all_faults() && (name == "SlraClblast" || name == "SlraMixed"))
      GTEST_SKIP() << "its kernels take long to compile; MOCLEAN_FAULTS=all tries it";
    folder_.write("walk.csv", small_walk(8));
    clean_folder();
    const Outcome whole = run_with("");
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    whole_ = results();
    for (const std::string& line : lines(content(folder_ / "calls"))) {
      const std::size_t space = line.find(' ');
      calls_[line.substr(0, space)] = std::stol(line.substr(space));
    }
  }

  static std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> found;
    for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != text.npos; begin = end + 1)
      found.push_back(text.substr(begin, end - begin));
    return found;
  }

  void clean_folder() {
    std::filesystem::remove_all(folder_ / "out");
    std::filesystem::create_directory(folder_ / "out");
  }

  std::vector<std::pair<std::string, std::string>> results() const {
    return contents_below(folder_, "out");
  }

  // An undisturbed run may have to compile the kernels.
  Outcome run_with(const std::string& fault) const {
    std::vector<std::string> command = {"denoise", folder_ / "walk.csv",
                                        "-o",      folder_ / "out/clean.csv",
                                        "--mask",  folder_ / "out/mask.csv"};
    const auto& options = GetParam().options;
    command.insert(command.end(), options.begin(), options.end());
    Program program(command, {.environment = {"LD_PRELOAD=" MOCLEAN_OPENCL_FAULTS_LIBRARY,
                                              "MOCLEAN_FAULT=" + fault,
                                              "MOCLEAN_FAULT_CALLS=" + (folder_ / "calls")}});
    return program.wait_at_most(std::chrono::seconds(fault.empty() ? 300 : 20));
  }

  void try_one(const OpenClFaultCase& fault) {
    SCOPED_TRACE(fault.text);
    FaultTable::Row& row = program_table[fault.function];
    clean_folder();

    const Outcome outcome = run_with(fault.text);

    ++row.injected;
    ASSERT_THAT(outcome.exit_code, AnyOf(0, 1)) << outcome.err;
    if (outcome.exit_code == 0) {
      ++row.harmless;
      EXPECT_TRUE(results() == whole_) << "a wrong result";
      return;
    }
    ++row.told;
    const bool profiling = outcome.err.find("--profile: ") != std::string::npos;
    EXPECT_TRUE(results().empty() || (profiling && results() == whole_))
        << ::testing::PrintToString(results());
    EXPECT_THAT(outcome.err, HasSubstr("moclean: "));
    // CLBlast says nothing of the function, and ends the process where it cannot allocate
    if (GetParam().name == "SlraClblast" && outcome.err.find("CLBlast") != std::string::npos)
      return;
    EXPECT_THAT(outcome.err, HasSubstr(named_in_messages(fault)));
    if (profiling) return;
    EXPECT_THAT(outcome.err, AnyOf(HasSubstr("walk.csv: "), HasSubstr("to open the device"),
                                   HasSubstr("to list the devices"), HasSubstr("to find kernel"),
                                   HasSubstr("to load a program"), HasSubstr("OpenCL compiler")));
  }

  void expect_the_next_run_whole() {
    clean_folder();
    EXPECT_EQ(run_with("").exit_code, 0);
    EXPECT_TRUE(results() == whole_) << "the next run differs";
  }

  TemporaryFolder folder_;
  std::vector<std::pair<std::string, std::string>> whole_;
  std::map<std::string, long> calls_;
};

// By default each work tries every seventh function, so that all works together try each.
TEST_P(OpenClFaults, AreToldWithTheTakeAndLeaveNothing) {
  const auto& works = opencl_works();
  const auto is_this = [](const OpenClWork& work) { return work.name == GetParam().name; };
  auto place = std::ranges::find_if(works, is_this) - works.begin();
  for (const auto& [function, calls] : calls_) {
    program_table[function].calls += calls;
    if (!all_faults() && ++place % 7 != 0) continue;
    for (const OpenClFaultCase& fault : faults_of(function, calls, all_faults() ? 25 : 1))
      try_one(fault);
    if (all_faults()) expect_the_next_run_whole();
  }
  expect_the_next_run_whole();
}

INSTANTIATE_TEST_SUITE_P(Of, OpenClFaults, ::testing::ValuesIn(opencl_works()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace moclean::test
