// moclean denoise --mask, --max-gap, --keep-observed.

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/formats/read_write.hpp"

#include "cli/program.hpp"
#include "support/matrix.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A walk of 120 Hz with a gap of 12 frames and one of 36.
Recording walk_with_gaps() {
  Recording walk = synthetic_walk(90);
  walk.samples.block(10, 3, 12, 3).setConstant(std::nan(""));
  walk.samples.block(40, 6, 36, 3).setConstant(std::nan(""));
  return walk;
}

class Gaps : public ::testing::Test {
 protected:
  Outcome denoise(const std::vector<std::string>& options) const {
    std::vector<std::string> arguments = {"denoise", csv_, "-o", output_};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  }

  TemporaryFolder folder_;
  Recording walk_ = walk_with_gaps();
  std::string csv_ = folder_.write("walk.csv", walk_);
  std::string output_ = folder_ / "clean.npy";
};

TEST_F(Gaps, LongOnesStayMissingAndTheMaskSaysSo) {
  const Outcome outcome = denoise({"--method", "completion:max-iterations=50", "--max-gap", "0.2",
                                   "--mask", folder_ / "mask.csv", "--json", folder_ / "run.json"});

  ASSERT_THAT(outcome.exit_code, ::testing::AnyOf(0, 3)) << outcome.err;
  const Matrix clean = read_recording(output_).samples;
  const Matrix mask = read_recording(folder_ / "mask.csv").samples;
  EXPECT_EQ(clean.array().isNaN().count(), 36 * 3);
  EXPECT_TRUE(clean.block(40, 6, 36, 3).array().isNaN().all());
  EXPECT_TRUE((mask.block(40, 6, 36, 3).array() == 3).all());
  EXPECT_TRUE((mask.block(10, 3, 12, 3).array() == 2).all());
  EXPECT_EQ((mask.array() >= 2).count(), 48 * 3);
  const auto samples = nlohmann::json::parse(content(folder_ / "run.json"))["inputs"][0]["samples"];
  EXPECT_EQ(samples["filled"], 36);
  EXPECT_EQ(samples["missing"], 108);
}

TEST_F(Gaps, WhatAFilterLeavesAloneIsKept) {
  ASSERT_EQ(denoise({"--method", "hampel", "--mask", folder_ / "mask.npy"}).exit_code, 0);

  const Matrix clean = read_recording(output_).samples;
  const Matrix mask = read_recording(folder_ / "mask.npy").samples;
  EXPECT_TRUE(((mask.array() == 0) == (clean.array() == walk_.samples.array())).all());
  EXPECT_EQ((mask.array() == 3).count(), 48 * 3);
}

TEST_F(Gaps, KeptSamplesPassThroughBitForBit) {
  const std::string whole = folder_.write("whole.npy", synthetic_walk(90));
  const std::vector<std::string> common = {"denoise", whole,    "-o",
                                           output_,   "--mask", folder_ / "mask.npy"};
  auto keeping = common;
  keeping.emplace_back("--keep-observed");
  ASSERT_EQ(run(common).exit_code, 0);
  const Matrix solved = read_recording(output_).samples;

  ASSERT_EQ(run(keeping).exit_code, 0);

  const Matrix kept = read_recording(output_).samples, truth = read_recording(whole).samples;
  const Matrix mask = read_recording(folder_ / "mask.npy").samples;
  EXPECT_GT((mask.array() == 0).count(), 0);
  for (Index f = 0; f < kept.rows(); ++f)
    for (Index c = 0; c < kept.cols(); ++c)
      ASSERT_EQ(kept(f, c), mask(f, c) == 0 ? truth(f, c) : solved(f, c)) << f << " " << c;
}

TEST_F(Gaps, MasksOfSeveralTakesGoIntoAFolder) {
  folder_.write("takes/a.npy", synthetic_walk(30));
  folder_.write("takes/b.csv", synthetic_walk(40));

  const Outcome outcome = run({"denoise", folder_ / "takes", "-o", folder_ / "clean", "--mask",
                               folder_ / "masks", "--method", "median"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_recording(folder_ / "masks/a.npy").frames(), 30);
  EXPECT_EQ(read_recording(folder_ / "masks/b.csv").frames(), 40);
}

TEST_F(Gaps, AMaskInTheWayOfAnotherResultIsRefused) {
  const Outcome outcome = denoise({"--mask", output_});

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("-o and --mask would both write " + output_));
  const Outcome twice = denoise({"--outliers", folder_ / "m.npy", "--mask", folder_ / "m.npy"});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("--outliers and --mask would both write"));
  EXPECT_THAT(folder_.names(), ElementsAre("walk.csv"));
}

TEST_F(Gaps, ALongestGapNeedsTheFrameRate) {
  const std::string rateless = folder_.write("rateless.npy", walk_);
  const std::vector<std::string> arguments = {"denoise",  rateless, "-o",        output_,
                                              "--method", "median", "--max-gap", "1"};

  const Outcome outcome = run(arguments);

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("states no frame rate, which --max-gap needs; give --rate"));
}

}  // namespace
}  // namespace moclean::test
