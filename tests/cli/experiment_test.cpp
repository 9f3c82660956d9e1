// moclean experiment: tables, grids, what a killed run leaves.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>

#include "moclean/formats/read_write.hpp"
#include "moclean/report/report.hpp"

#include "cli/program.hpp"
#include "support/data.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::test {
namespace {

using ::testing::HasSubstr;

const char* const grid = R"(seeds = 2
[[take]]
file = "walk.csv"
[[take]]
file = "nowhere.csv"
optional = true
[[noise]]
spec = "gaussian-frames:fraction=0.3"
label = "frames"
[[method]]
spec = "none"
[[method]]
spec = "slra:segments=2"
[[method]]
spec = "hampel:window=5,sigmas=3+butterworth:cutoff=20"
label = "chain"
)";

// The lines of a CSV without the column `seconds`.
std::vector<std::string> without_seconds(const std::string& csv) {
  std::vector<std::string> lines;
  std::size_t column = 0;
  std::istringstream rows(csv);
  for (std::string row; std::getline(rows, row);) {
    std::vector<std::string> fields;
    std::istringstream cells(row);
    for (std::string cell; std::getline(cells, cell, ',');) fields.push_back(cell);
    if (lines.empty())
      column = static_cast<std::size_t>(std::ranges::find(fields, "seconds") - fields.begin());
    std::string line;
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (i != column) line += fields[i] + ",";
    lines.push_back(line);
  }
  return lines;
}

class ExperimentCommand : public ::testing::Test {
 protected:
  Outcome run_grid(const std::string& output, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"experiment", "grid", config_, "-o", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  nlohmann::json record(const std::string& file) const {
    return nlohmann::json::parse(content(file));
  }

  TemporaryFolder folder_;
  std::string walk_ = folder_.write("walk.csv", synthetic_walk(90));
  std::string config_ = folder_.write_text("grid.toml", grid);
};

TEST_F(ExperimentCommand, GridWritesAllItsFiles) {
  const Outcome outcome = run_grid(folder_ / "out");

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("nowhere.csv is not there; this take is left out"));
  EXPECT_THAT(outcome.out, HasSubstr("| method"));
  EXPECT_THAT(outcome.out, HasSubstr("| slra:segments=2 |"));
  for (const char* name : {"out/cells.csv", "out/cells.jsonl", "out/summary.json"})
    EXPECT_THAT(folder_.names(), testing::Contains(name));
  EXPECT_EQ(std::filesystem::exists(folder_ / "out/report.html"), report_available());
  const nlohmann::json summary = record(folder_ / "out/summary.json");
  EXPECT_EQ(summary["takes"].size(), 1U);
  EXPECT_EQ(summary["missing_takes"].size(), 1U);
  EXPECT_EQ(summary["ranking"].size(), 3U);
  EXPECT_EQ(summary["by_noise"][0]["figures"]["fd"]["count"], 2);
}

TEST_F(ExperimentCommand, GridGivesTheFiguresOfTheCommandsByHand) {
  ASSERT_EQ(run_grid(folder_ / "out", {"--quiet"}).exit_code, 0);
  const std::string csv = content(folder_ / "out/cells.csv");
  const std::size_t at = csv.find("walk,frames,slra:segments=2,2,");
  ASSERT_NE(at, csv.npos) << csv;
  const std::string seed = csv.substr(at + 30, csv.find(',', at + 30) - at - 30);

  run({"corrupt", walk_, "-o", folder_ / "noisy.csv", "--noise", "gaussian-frames:fraction=0.3",
       "--seed", seed, "--mask", folder_ / "mask.csv"});
  run({"denoise", folder_ / "noisy.csv", "-o", folder_ / "clean.csv", "--segments", "2",
       "--outliers", folder_ / "outliers.csv"});
  const nlohmann::json figures =
      run({"evaluate", walk_, folder_ / "clean.csv", "--mask", folder_ / "mask.csv", "--outliers",
           folder_ / "outliers.csv", "--json"})
          .json()["figures"];

  const std::string lines = content(folder_ / "out/cells.jsonl");
  nlohmann::json cell;
  std::istringstream rows(lines);
  for (std::string row; std::getline(rows, row);)
    if (row.find("seed " + seed) != row.npos && row.find("| slra:") != row.npos)
      cell = nlohmann::json::parse(row);
  ASSERT_FALSE(cell.is_null()) << lines;
  EXPECT_GE(figures.size(), 9U);
  for (const auto& [name, value] : figures.items()) EXPECT_EQ(cell["figures"][name], value) << name;
}

TEST_F(ExperimentCommand, GridIsDeterministicAndDoesNothingTwice) {
  ASSERT_EQ(run_grid(folder_ / "one", {"--quiet"}).exit_code, 0);
  ASSERT_EQ(run_grid(folder_ / "two", {"--quiet"}).exit_code, 0);
  EXPECT_EQ(without_seconds(content(folder_ / "one/cells.csv")),
            without_seconds(content(folder_ / "two/cells.csv")));

  const std::string before = content(folder_ / "one/cells.csv");
  const std::string lines = content(folder_ / "one/cells.jsonl");
  ASSERT_EQ(run_grid(folder_ / "one", {"--quiet"}).exit_code, 0);
  EXPECT_EQ(content(folder_ / "one/cells.csv"), before);  // the times, too
  EXPECT_EQ(content(folder_ / "one/cells.jsonl"), lines);
}

TEST_F(ExperimentCommand, AKilledGridIsContinued) {
  ASSERT_EQ(run_grid(folder_ / "whole", {"--quiet", "--seeds", "40"}).exit_code, 0);
  {
    Program killed({"experiment", "grid", config_, "-o", folder_ / "out", "--seeds", "40",
                    "--memory-limit", "1M"});
    while (!std::filesystem::exists(folder_ / "out/cells.jsonl") ||
           content(folder_ / "out/cells.jsonl").find('\n') == std::string::npos)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    killed.send(SIGKILL);
    EXPECT_EQ(killed.wait().exit_code, -SIGKILL);
  }
  const std::string left = content(folder_ / "out/cells.jsonl");
  const std::string kept = left.substr(0, left.rfind('\n') + 1);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/cells.csv"));

  const Outcome outcome = run_grid(folder_ / "out", {"--quiet", "--seeds", "40"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(content(folder_ / "out/cells.jsonl"), testing::StartsWith(kept));
  EXPECT_EQ(without_seconds(content(folder_ / "out/cells.csv")),
            without_seconds(content(folder_ / "whole/cells.csv")));
}

TEST_F(ExperimentCommand, GridErrorsNameFileLineAndKey) {
  folder_.write_text("grid.toml", std::string(grid) + "speck = 3\n");

  const Outcome outcome = run_grid(folder_ / "out");

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("grid.toml:17: method 3: speck: unknown key"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(ExperimentCommand, TablesHaveARowPerMethodAndLength) {
  const Outcome second = run({"experiment", "table2", walk_, "--seeds", "2"});
  const Outcome third = run({"experiment", "table3", walk_, "--seeds", "2", "--frames", "10:70",
                             "--json", "-", "--device", "cpu"});

  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_THAT(second.out, HasSubstr("walk.csv: 90 frames, 30 of them noisy"));
  EXPECT_THAT(second.out, HasSubstr("| svt, threshold by the rule |"));
  EXPECT_THAT(second.out, HasSubstr("tau = (1 + sqrt(beta)) / sqrt(mu) times"));
  ASSERT_EQ(third.exit_code, 0) << third.err;
  const nlohmann::json take = third.json()["takes"][0];
  EXPECT_EQ(take["frames"], 60);
  EXPECT_EQ(take["noise"], "gaussian-frames:frames=20,mean=1,sd=1.2");
  EXPECT_EQ(take["rows"].back()["label"], "whole (rpca)");
  EXPECT_EQ(take["rows"].back()["fd"]["values"].size(), 2U);
}

// SLRA of 400 frames within 4 % of 0.242, RPCA within 3 % of 0.515, TSVD of rank 10 within 3 % of
// 0.544: independent figures of NumPy on two seeds.
TEST_F(ExperimentCommand, ThePapersTakeGivesItsFigures) {
  const auto take = shared_data("cmu/14/14_06.amc");
  MOCLEAN_REQUIRE_FILE(take);

  const auto record = run({"experiment", "table2", take, "--seeds", "1", "--json", "-"}).json();

  const nlohmann::json rows = record["takes"][0]["rows"];
  EXPECT_EQ(record["takes"][0]["sequence"], "Seq3");
  EXPECT_NEAR(rows[1]["fd"]["mean"], 0.242, 0.04 * 0.242);
  EXPECT_NEAR(rows[2]["fd"]["mean"], 0.544, 0.03 * 0.544);
  EXPECT_NEAR(rows[4]["fd"]["mean"], 0.515, 0.03 * 0.515);
  EXPECT_EQ(rows[4]["paper"], 0.5238);
}

}  // namespace
}  // namespace moclean::test
