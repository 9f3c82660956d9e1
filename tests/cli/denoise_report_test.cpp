// moclean denoise --report and --truth.

#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "moclean/report/report.hpp"

#include "cli/program.hpp"
#include "formats/tiny_files.hpp"
#include "support/synthetic_walk.hpp"
#include "support/tolerance.hpp"

namespace moclean::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

// A walk and the same with an error of 3 in one joint for five frames.
class DenoiseReport : public ::testing::Test {
 protected:
  DenoiseReport() {
    Recording walk = synthetic_walk(90);
    truth_ = folder_.write("truth/walk.csv", walk);
    walk.samples.block(10, 6, 5, 3).array() += 3;
    noisy_ = folder_.write("walk.csv", walk);
  }

  std::vector<std::string> denoise(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {
        "denoise",          noisy_, "-o", folder_ / "clean.npy", "--backend", "reference",
        "--segment-length", "45"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  TemporaryFolder folder_;
  std::string truth_;
  std::string noisy_;
};

TEST_F(DenoiseReport, TruthGivesTheFiguresOfEvaluate) {
  const Outcome outcome = run(denoise({"--truth", truth_, "--json", "-"}));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;

  const nlohmann::json record = outcome.json()["inputs"][0]["truth"];
  const nlohmann::json clean = run({"evaluate", truth_, folder_ / "clean.npy", "--json"}).json();

  EXPECT_EQ(record["file"], truth_);
  EXPECT_NEAR(record["fd_noisy"].get<double>(), std::sqrt(15 * 9.0 / (90 * 93)),
              tolerance::by_hand(3));
  EXPECT_EQ(record["fd_clean"], clean["fd"]);
  EXPECT_THAT(run(denoise({"--truth", truth_})).out, HasSubstr("FD from the truth 0.127 -> "));
}

TEST_F(DenoiseReport, TruthIsCutLikeTheInputOrAsItSays) {
  const nlohmann::json same =
      run(denoise({"--truth", truth_, "--frames", "5:50", "--json", "-"})).json();
  EXPECT_EQ(same["inputs"][0]["frames"], 45);

  const std::string longer = folder_.write("longer.csv", synthetic_walk(120));
  const Outcome uncut = run(denoise({"--truth", longer}));
  EXPECT_EQ(uncut.exit_code, 1);
  EXPECT_THAT(uncut.err, AllOf(HasSubstr("longer.csv"), HasSubstr("--truth-frames")));
  EXPECT_EQ(run(denoise({"--truth", longer, "--truth-frames", "0:90"})).exit_code, 0);
}

// From a pipe, which can be read only once: a second reader would wait for ever.
TEST_F(DenoiseReport, NeedsEveryFileOnce) {
  if (!report_available()) GTEST_SKIP() << "built without libjs-three and libjs-dygraphs";
  const std::string pipe = folder_ / "pipe.bvh", page = folder_ / "report.html";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::jthread writer([&] { std::ofstream(pipe) << tiny_bvh; });

  const Outcome outcome =
      run({"denoise", pipe, "-o", folder_ / "clean.npy", "--method", "median", "--report", page});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(content(page), HasSubstr("\"parents\":[-1,0,1]"));
}

TEST_F(DenoiseReport, IsOnePageForOneTake) {
  if (!report_available()) GTEST_SKIP() << "built without libjs-three and libjs-dygraphs";

  const Outcome outcome = run(denoise({"--truth", truth_, "--report", folder_ / "report.html"}));

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string page = content(folder_ / "report.html");
  EXPECT_THAT(page,
              AllOf(HasSubstr("The take got better"), HasSubstr("<title>walk.csv"),
                    HasSubstr("equal segments of about 45 frames"), HasSubstr("\"truth\":{")));
}

TEST_F(DenoiseReport, IsAFolderWhereTheOutputIsOne) {
  if (!report_available()) GTEST_SKIP() << "built without libjs-three and libjs-dygraphs";
  folder_.write("takes/walk.csv", synthetic_walk(60, 2));
  folder_.write("takes/other.npy", synthetic_walk(50, 3));

  const Outcome outcome = run({"denoise", folder_ / "takes", "-o", folder_ / "clean", "--report",
                               folder_ / "reports", "--backend", "reference"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(folder_.names(),
              AllOf(Contains("reports/walk.html"), Contains("reports/other.html")));
  EXPECT_THAT(content(folder_ / "reports/other.html"), HasSubstr("Only a truth (--truth)"));
}

TEST_F(DenoiseReport, RefusesWhatDoesNotGoTogether) {
  const Outcome format = run(denoise({"--report", folder_ / "report.pdf"}));
  EXPECT_THAT(format.err,
              HasSubstr(report_available() ? "ending in .html" : "install libjs-three"));
  EXPECT_NE(format.exit_code, 0);

  const Outcome missing = run(denoise({"--truth", folder_ / "none.csv"}));
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("no such file"));

  const Outcome several = run({"denoise", noisy_, truth_, "-o", folder_ / "clean", "--truth",
                               truth_, "--backend", "reference"});
  EXPECT_EQ(several.exit_code, 2);
  EXPECT_EQ(run(denoise({"--truth-frames", "0:9"})).exit_code, 2);
}

TEST_F(DenoiseReport, NothingIsWrittenIfATruthDoesNotFit) {
  const std::string other = folder_.write("other.csv", synthetic_walk(12));
  const std::vector<std::string> before = folder_.names();

  const Outcome outcome = run(denoise({"--truth", other, "--report", folder_ / "report.html"}));

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(folder_.names(), before);
}

}  // namespace
}  // namespace moclean::test
