// moclean tune, and what moclean denoise makes of it; --profile and --precision.

#include <csignal>
#include <fstream>

#include <gmock/gmock.h>
#include <unistd.h>

#include "moclean/formats/read_write.hpp"

#include "cli/program.hpp"
#include "support/matrix.hpp"
#include "support/synthetic_walk.hpp"
#include "support/tolerance.hpp"

namespace moclean::test {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class Tune : public ::testing::Test {
 protected:
  Outcome tune(std::vector<std::string> options) const {
    options.insert(options.begin(), "tune");
    return run(options, {.cache = cache_});
  }
  Outcome denoise(std::vector<std::string> options) const {
    options.insert(options.begin(), {"denoise", input_, "-o", output_, "--method", "slra"});
    return run(options, {.cache = cache_});
  }

  TemporaryFolder folder_;
  std::string cache_ = folder_ / "cache";
  std::string input_ = folder_.write("walk.npy", synthetic_walk(120));
  std::string output_ = folder_ / "clean.npy";
};

TEST_F(Tune, KeepsAChoiceThatDenoiseUses) {
  const Outcome tuned =
      tune({"--quick", "--frames", "30", "--columns", "12", "--json", folder_ / "tune.json"});

  ASSERT_EQ(tuned.exit_code, 0) << tuned.err;
  EXPECT_THAT(tuned.out, HasSubstr("bit-identical"));
  EXPECT_THAT(tuned.out, HasSubstr("kept: "));
  const auto record = nlohmann::json::parse(content(folder_ / "tune.json"));
  const std::string file = record["file"];
  EXPECT_THAT(file, HasSubstr(cache_ + "/moclean/tuning-"));
  for (const auto& tried : record["tried"]) EXPECT_EQ(tried["result"], "bit-identical");
  auto kept = record["kept"];
  kept["file"] = file;

  const Outcome with = denoise({"--json", "-"});
  const std::string result = content(output_);
  const Outcome without = denoise({"--json", "-", "--no-tuning"});

  ASSERT_EQ(with.exit_code, 0) << with.err;
  EXPECT_EQ(with.json()["tuning"], kept);
  EXPECT_EQ(without.json()["tuning"]["file"], nullptr);
  EXPECT_TRUE(content(output_) == result) << "bit-identical choices";
}

TEST_F(Tune, DamagedFileIsIgnoredWithAWarning) {
  const Outcome tuned = tune({"--quick", "--frames", "9", "--columns", "3", "--json", "-"});
  const std::string file = tuned.json()["file"];
  ASSERT_EQ(denoise({"--no-tuning"}).exit_code, 0);
  const std::string result = content(output_);
  std::ofstream(file) << "{";

  const Outcome outcome = denoise({"--json", "-"});
  const Outcome not_asked = denoise({"--no-tuning"});

  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("ignoring the kept tuning: " + file));
  EXPECT_EQ(outcome.json()["tuning"]["file"], nullptr);
  EXPECT_TRUE(content(output_) == result);
  EXPECT_THAT(not_asked.err, Not(HasSubstr("tuning")));
}

TEST_F(Tune, InterruptKeepsNothing) {
  Program program({"tune", "--frames", "400"}, {.cache = cache_});
  usleep(500'000);  // its first act is to take the signal over; it takes far longer than this

  program.send(SIGINT);
  const Outcome outcome = program.wait();

  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_THAT(outcome.err, HasSubstr("nothing was written"));
  EXPECT_THAT(folder_.names(), Each(Not(HasSubstr("tuning-"))));
}

TEST_F(Tune, RejectsSizesOutOfRange) {
  EXPECT_EQ(tune({"--frames", "1"}).exit_code, 2);
  EXPECT_EQ(tune({"--columns", "1001"}).exit_code, 2);
}

TEST_F(Tune, ProfileListsEveryKernelAndLeavesTheResultAsItIs) {
  ASSERT_EQ(denoise({}).exit_code, 0);
  const std::string result = content(output_);

  const Outcome profiled = denoise({"--profile", "--json", folder_ / "record.json"});
  const Outcome quiet = denoise({"--profile", "--quiet"});

  EXPECT_TRUE(content(output_) == result);
  EXPECT_THAT(profiled.out, HasSubstr("sweep_full"));
  EXPECT_THAT(profiled.out, HasSubstr("peak of the device"));
  EXPECT_THAT(quiet.out, IsEmpty());
  const auto profile = nlohmann::json::parse(content(folder_ / "record.json"))["profile"];
  EXPECT_GT(profile["peak"]["double_flops"], 0);
  EXPECT_GT(profile["peak"]["bytes"], 0);
  double share = 0;
  for (const auto& kernel : profile["kernels"]) {
    EXPECT_GE(kernel["calls"], 1);
    share += kernel["share_of_time"].get<double>();
    if (kernel["kernel"] == "sweep_full") {
      EXPECT_GT(kernel["share_of_peak"], 0);
      EXPECT_LT(kernel["share_of_peak"], 1.5);
    }
    if (kernel["kernel"] == "diagonalise") {
      EXPECT_EQ(kernel["flops_per_second"], nullptr);
    }
  }
  EXPECT_GT(share, 0);
  EXPECT_LE(share, 1.01);
}

TEST_F(Tune, MixedPrecisionIsVerifiedToItsOwnBounds) {
  const Outcome outcome =
      denoise({"--precision", "mixed", "--verify", "--json", folder_ / "record.json"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("bound 1e-05"));
  const auto record = nlohmann::json::parse(content(folder_ / "record.json"));
  EXPECT_EQ(record["precision"], "mixed");
  EXPECT_EQ(record["method"]["tolerance"], 1e-6);
  EXPECT_GT(record["inputs"][0]["agreement"]["low_rank"], 0);
}

TEST_F(Tune, MixedPrecisionTakesALargerToleranceAsGiven) {
  const Outcome outcome = denoise({"--precision", "mixed", "--tolerance", "1e-5", "--json", "-"});

  EXPECT_EQ(outcome.json()["method"]["tolerance"], 1e-5);
}

TEST_F(Tune, OptionsThatDoNotGoTogetherAreUsageErrors) {
  const std::vector<std::string> wrong[] = {{"--precision", "mixed", "--backend", "reference"},
                                            {"--precision", "mixed", "--products", "clblast"},
                                            {"--precision", "mixed", "--products", "group"},
                                            {"--precision", "mixed", "--form", "gpu"},
                                            {"--precision", "mixed", "--tolerance", "1e-7"},
                                            {"--precision", "half"},
                                            {"--profile", "--backend", "reference"}};
  for (const auto& options : wrong) {
    const Outcome outcome = denoise(options);

    EXPECT_EQ(outcome.exit_code, 2) << options[1];
    EXPECT_THAT(outcome.err, HasSubstr(options[0]));
  }
  EXPECT_THAT(folder_.names(), SizeIs(1)) << "only the input";
}

}  // namespace
}  // namespace moclean::test
