// moclean denoise without --method, and what auto says of its result.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/random.hpp"
#include "moclean/formats/read_write.hpp"

#include "cli/program.hpp"
#include "support/matrix.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

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
  Recording walk_ = synthetic_walk(150);
  std::string csv_;
  std::string output_ = folder_ / "clean.npy";
};

TEST_F(Auto, IsTheDefaultAndAgreesWithTheReference) {
  const Outcome outcome = denoise({"--verify", "--mask", folder_ / "mask.npy"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(record()["method"]["specification"],
            "auto:window=2000,overlap=100,body=on,reject=auto,smooth=on,confidence=on");
  EXPECT_EQ(record()["method"]["reject"], "auto");
  EXPECT_EQ(record()["method"]["smooth"], "on");
  const Matrix clean = read_recording(output_).samples;
  EXPECT_TRUE(clean.allFinite());
  const Matrix mask = read_recording(folder_ / "mask.npy").samples;
  EXPECT_TRUE((mask.block(60, 3, 20, 3).array() == 2).all());
}

TEST_F(Auto, GivesWayToSlraWhereItsOptionsAreGiven) {
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--segments", "2"}, {"--lambda-scale", "1.2"}}) {
    ASSERT_EQ(denoise(options).exit_code, 0);
    EXPECT_EQ(record()["method"]["name"], "slra");
  }
}

TEST_F(Auto, ClaimsNeitherRankNorConvergence) {
  const Outcome outcome = denoise({});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json segment = record()["inputs"][0]["segments"][0];
  EXPECT_TRUE(segment["rank"].is_null());
  EXPECT_TRUE(segment["residual"].is_null());
  EXPECT_TRUE(segment["converged"].is_null());
  EXPECT_GT(segment["iterations"], 0);
  EXPECT_THAT(outcome.out, Not(HasSubstr("rank")));
}

TEST_F(Auto, RefusesAMatrixThatIsNoMotion) {
  Random random(6);
  Recording matrix = walk_;
  for (double& x : matrix.samples.reshaped()) x = random.normal();
  const std::string file = folder_.write("matrix.csv", matrix);

  const Outcome outcome = run({"denoise", csv_, file, "-o", folder_ / "clean"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr(file + ": its rows are not smooth in time"),
                                 HasSubstr("--method rpca")));
  EXPECT_EQ(run({"denoise", file, "-o", output_, "--method", "rpca"}).exit_code, 0);
}

TEST_F(Auto, SaysWhatWasChangedAndAloudWhenItIsMuch) {
  EXPECT_THAT(denoise({}).err, IsEmpty());
  EXPECT_NEAR(record()["inputs"][0]["changed"]["filled"].get<double>(), 60. / (150 * 93), 1e-12);

  Recording spoilt = walk_;
  spoilt.samples.block(100, 30, 4, 3).array() += 15;
  folder_.write("walk.csv", spoilt);
  for (const std::vector<std::string>& options : {std::vector<std::string>{}, {"--quiet"}}) {
    const Outcome outcome = denoise(options);
    EXPECT_THAT(outcome.err, StartsWith("moclean: " + csv_ + ": changed much: "));
    EXPECT_THAT(outcome.err, HasSubstr("% filled; farthest: " + joints(walk_)[10].name + " by 2"));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1);
  }
  const nlohmann::json changed = record()["inputs"][0]["changed"];
  EXPECT_GE(changed["corrected"], 12. / (150 * 93));
  EXPECT_EQ(changed["largest"]["joint"], joints(walk_)[10].name);
  EXPECT_NEAR(changed["largest"]["distance"].get<double>(), 15 * std::sqrt(3), 1);
  EXPECT_GE(changed["largest"]["frame"], 100);
  EXPECT_LT(changed["largest"]["frame"], 104);
  EXPECT_GT(changed["largest"]["share_of_body"], 0.05);
}

TEST_F(Auto, OptionsOfRejectionAndSmoothingReachIt) {
  Recording spoilt = walk_;
  Random random(2);
  for (double& x : spoilt.samples.reshaped()) x += 0.05 * random.normal();
  spoilt.samples.block(100, 30, 4, 3).array() += 15;
  folder_.write("walk.csv", spoilt);

  ASSERT_EQ(denoise({"--method", "auto:reject=off"}).exit_code, 0);
  EXPECT_EQ(record()["method"]["reject"], "off");
  EXPECT_EQ(record()["inputs"][0]["samples"]["corrected"], 0);

  ASSERT_EQ(denoise({"--method", "auto:smooth=off"}).exit_code, 0);
  EXPECT_EQ(record()["method"]["smooth"], "off");
  const Matrix clean = read_recording(output_).samples, noisy = read_recording(csv_).samples;
  EXPECT_TRUE(clean.row(20) == noisy.row(20));
  EXPECT_GT((clean.row(101) - noisy.row(101)).norm(), 20);
  ASSERT_EQ(denoise({"--keep-observed"}).exit_code, 0);
  EXPECT_TRUE(same_bits(read_recording(output_).samples, clean));
}

TEST_F(Auto, WritesItsStandardDeviation) {
  ASSERT_EQ(denoise({"--sigma", folder_ / "sigma.csv"}).exit_code, 0);

  const Matrix sigma = read_recording(folder_ / "sigma.csv").samples;
  EXPECT_TRUE((sigma.array() > 0).all());
  EXPECT_GT(sigma(70, 3), 10 * sigma(30, 3));
}

TEST_F(Auto, RunsWithinAChain) {
  ASSERT_EQ(denoise({"--method", "hampel+auto:window=80+butterworth:cutoff=10"}).exit_code, 0);

  EXPECT_TRUE(read_recording(output_).samples.allFinite());
  EXPECT_EQ(denoise({"--method", "auto:window=3"}).exit_code, 2);
}

}  // namespace
}  // namespace moclean::test
