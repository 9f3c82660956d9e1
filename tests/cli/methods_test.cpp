// moclean denoise --method: chains, filters, completion, frame rates and gaps.

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/denoise/chain.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/noise/noise.hpp"

#include "cli/program.hpp"
#include "support/matrix.hpp"
#include "support/synthetic_walk.hpp"
#include "support/tolerance.hpp"

namespace moclean::test {
namespace {

using ::testing::HasSubstr;

class Methods : public ::testing::Test {
 protected:
  Outcome denoise(const std::string& input, const std::string& method,
                  const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"denoise", input, "-o", output_, "--method", method};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  Matrix expected(const std::string& method) const {
    ReferenceBackend backend(2);
    return ChainDenoiser(parse_chain(method), &backend).denoise({&walk_, 1}).at(0).motion;
  }

  TemporaryFolder folder_;
  Recording walk_ = corrupt(synthetic_walk(90), GaussianFrames{.fraction = 0.3}, 1).clip;
  std::string csv_ = folder_.write("walk.csv", walk_);
  std::string npy_ = folder_.write("rateless.npy", walk_);
  std::string output_ = folder_ / "clean.npy";
};

TEST_F(Methods, AChainOfFiltersGivesWhatTheLibraryGives) {
  const std::string chain = "hampel:window=7,sigmas=3+butterworth:cutoff=10";

  const Outcome outcome = denoise(csv_, chain, {"--json", folder_ / "run.json"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("90 frames x 93 columns, 0."));
  EXPECT_TRUE(same_bits(read_recording(output_).samples, expected(chain)));
  const auto record = nlohmann::json::parse(content(folder_ / "run.json"));
  EXPECT_EQ(record["device"], "host (filters)");
  EXPECT_EQ(record["method"]["specification"],
            "hampel:window=7,sigmas=3+butterworth:cutoff=10,order=4");
  EXPECT_TRUE(record["inputs"][0]["segments"].empty());
}

TEST_F(Methods, FiltersOpenNoDevice) {
  const Outcome outcome =
      run({"denoise", csv_, "-o", output_, "--method", "median"}, {.device = "no such device"});

  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST_F(Methods, MatrixMethodsAgreeWithTheReference) {
  for (const char* method : {"tsvd:rank=5", "svt:shrink=hard,segments=2", "hampel+slra+median"}) {
    const Outcome outcome = denoise(csv_, method, {"--verify"});

    ASSERT_EQ(outcome.exit_code, 0) << method << ": " << outcome.err;
    EXPECT_LE(relative_difference(read_recording(output_).samples, expected(method)),
              tolerance::backends_low_rank())
        << method;
  }
}

TEST_F(Methods, OptionsFillInWhatASpecificationLeavesOpen) {
  const Outcome outcome =
      denoise(csv_, "median:window=3+slra:rho=1.7", {"--segments", "3", "--lambda-scale", "1.2"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_LE(
      relative_difference(read_recording(output_).samples,
                          expected("median:window=3+slra:rho=1.7,segments=3,lambda-scale=1.2")),
      tolerance::backends_low_rank());
}

TEST_F(Methods, SegmentsOverlapAsTheOptionOrTheKeySays) {
  const Outcome option =
      denoise(csv_, "slra",
              {"--segments", "3", "--overlap", "12", "--verify", "--json", folder_ / "run.json"});

  ASSERT_EQ(option.exit_code, 0) << option.err;
  const Matrix by_option = read_recording(output_).samples;
  EXPECT_LE(relative_difference(by_option, expected("slra:segments=3,overlap=12")),
            tolerance::backends_low_rank());
  const auto record = nlohmann::json::parse(content(folder_ / "run.json"));
  EXPECT_EQ(record["method"]["segmentation"],
            (nlohmann::json{{"segments", 3}, {"overlap", 12}, {"automatic", false}}));
  EXPECT_EQ(record["inputs"][0]["segments"][1]["first_frame"], 24);
  EXPECT_EQ(record["inputs"][0]["segments"][1]["frames"], 42);
  ASSERT_EQ(denoise(csv_, "slra:segments=3,overlap=12").exit_code, 0);
  EXPECT_TRUE(same_bits(read_recording(output_).samples, by_option));
}

TEST_F(Methods, AutomaticSegmentsAreThoseOfTheReference) {
  const Outcome outcome = denoise(
      csv_, "slra:segments=3", {"--segment", "auto", "--verify", "--json", folder_ / "run.json"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_LE(relative_difference(read_recording(output_).samples,
                                expected("slra:segments=3,segment=auto")),
            tolerance::backends_low_rank());
  const auto record = nlohmann::json::parse(content(folder_ / "run.json"));
  EXPECT_EQ(record["method"]["segmentation"]["automatic"], true);
  EXPECT_EQ(record["inputs"][0]["segments"].size(), 3);
}

TEST_F(Methods, AFilterInHertzNeedsTheFrameRate) {
  const Outcome without = denoise(npy_, "butterworth:cutoff=10");
  const Outcome with = denoise(npy_, "butterworth:cutoff=10", {"--rate", "120"});

  EXPECT_EQ(without.exit_code, 1);
  EXPECT_THAT(without.err, HasSubstr("states no frame rate, which butterworth needs; give --rate"));
  EXPECT_EQ(with.exit_code, 0) << with.err;
  EXPECT_TRUE(same_bits(read_recording(output_).samples, expected("butterworth:cutoff=10")));
}

TEST_F(Methods, FiltersKeepGapsAndOthersFillThem) {
  Recording holey = walk_;
  holey.samples.block(20, 3, 15, 3).setConstant(std::nan(""));
  const std::string input = folder_.write("holey.csv", holey);

  ASSERT_EQ(denoise(input, "hampel").exit_code, 0);
  EXPECT_EQ(read_recording(output_).samples.array().isNaN().count(), 45);
  ASSERT_EQ(denoise(input, "hampel+completion").exit_code, 0);
  EXPECT_TRUE(read_recording(output_).samples.allFinite());
  ASSERT_EQ(denoise(input, "hampel+interpolate:kind=pchip+tsvd:rank=5").exit_code, 0);
  EXPECT_TRUE(read_recording(output_).samples.allFinite());
  const Outcome refused = denoise(input, "hampel+tsvd:rank=5");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("frame 20, column joint1.x is nan"));
}

TEST_F(Methods, NamesColumnsThatWereNeverObserved) {
  Recording blind = walk_;
  blind.samples.col(4).setConstant(std::nan(""));
  const std::string input = folder_.write("blind.csv", blind);

  const Outcome outcome = denoise(input, "slra:tolerance=1e-3");

  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr(input + ": never observed, left missing: joint1.y"));
  EXPECT_TRUE(read_recording(output_).samples.col(4).array().isNaN().all());
}

}  // namespace
}  // namespace moclean::test
