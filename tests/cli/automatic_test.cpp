// moclean denoise without --method, and what auto says of its result.

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/io/read_write.hpp"

#include "cli/program.hpp"
#include "support/matrix.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::test {
namespace {

class Auto : public ::testing::Test {
 protected:
  Auto() {
    walk_.samples.block(60, 3, 20, 3).setConstant(std::nan(""));
    csv_ = folder_.write("walk.csv", walk_);
  }

  Outcome denoise(std::vector<std::string> options) const {
    std::vector<std::string> arguments = {"denoise", csv_,     "-o",
                                          output_,   "--json", folder_ / "run.json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  }
  nlohmann::json record() const { return nlohmann::json::parse(content(folder_ / "run.json")); }

  TemporaryFolder folder_;
  Clip walk_ = synthetic_walk(150);
  std::string csv_;
  std::string output_ = folder_ / "clean.npy";
};

TEST_F(Auto, IsTheDefaultAndAgreesWithTheReference) {
  const Outcome outcome = denoise({"--verify", "--mask", folder_ / "mask.npy"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(record()["method"]["specification"], "auto:window=2000,overlap=100,body=on");
  const Matrix clean = read_clip(output_).samples;
  EXPECT_TRUE(clean.allFinite());
  const Matrix mask = read_clip(folder_ / "mask.npy").samples;
  EXPECT_TRUE((mask.block(60, 3, 20, 3).array() == 2).all());
}

TEST_F(Auto, GivesWayToSlraWhereItsOptionsAreGiven) {
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--segments", "2"}, {"--lambda-scale", "1.2"}}) {
    ASSERT_EQ(denoise(options).exit_code, 0);
    EXPECT_EQ(record()["method"]["name"], "slra");
  }
}

TEST_F(Auto, WritesItsStandardDeviation) {
  ASSERT_EQ(denoise({"--sigma", folder_ / "sigma.csv"}).exit_code, 0);

  const Matrix sigma = read_clip(folder_ / "sigma.csv").samples;
  EXPECT_TRUE((sigma.array() > 0).all());
  EXPECT_GT(sigma(70, 3), 10 * sigma(30, 3));
}

TEST_F(Auto, RunsWithinAChain) {
  ASSERT_EQ(denoise({"--method", "hampel+auto:window=80+butterworth:cutoff=10"}).exit_code, 0);

  EXPECT_TRUE(read_clip(output_).samples.allFinite());
  EXPECT_EQ(denoise({"--method", "auto:window=3"}).exit_code, 2);
}

}  // namespace
}  // namespace moclean::test
