#include <cmath>

#include <gmock/gmock.h>

#include "cli/program.hpp"
#include "support/data.hpp"
#include "support/synthetic_walk.hpp"
#include "support/tolerance.hpp"

namespace moclean::test {
namespace {

using ::testing::HasSubstr;

// Two joints over two frames; the estimate is off by 3 in Hip.x of frame 0 and by 4 in Head.y of
// frame 1.
class Evaluate : public ::testing::Test {
 protected:
  Evaluate() {
    Recording clip{.samples = Matrix::Zero(2, 6),
                   .columns = {"Hip.x", "Hip.y", "Hip.z", "Head.x", "Head.y", "Head.z"},
                   .frame_rate = 0,
                   .unit = ""};
    truth_ = folder_.write("truth.csv", clip);
    clip.samples(0, 0) = 3;
    clip.samples(1, 4) = 4;
    estimate_ = folder_.write("estimate.csv", clip);
  }

  TemporaryFolder folder_;
  std::string truth_;
  std::string estimate_;
};

TEST_F(Evaluate, JsonHoldsTheFiguresComputedByHand) {
  const Outcome outcome = run({"evaluate", truth_, estimate_, "--json"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json record = outcome.json();
  EXPECT_NEAR(record["fd"].get<double>(), 5 / std::sqrt(12.0), tolerance::by_hand(1));
  EXPECT_NEAR(record["rmse_changed"].get<double>(), 5 / std::sqrt(2.0), tolerance::by_hand(4));
  EXPECT_EQ(record["changed"], 2);
  EXPECT_EQ(record["largest"], 4);
  EXPECT_EQ(record["worst_joint"], "Head");
  EXPECT_EQ(record["not_compared"], 0);
  EXPECT_EQ(record["frames"], 2);
  EXPECT_EQ(record["columns"], 6);
  ASSERT_EQ(record["joints"].size(), 2);
  const nlohmann::json head = record["joints"][1];
  EXPECT_EQ(head["name"], "Head");
  EXPECT_NEAR(head["rmse"].get<double>(), 4 / std::sqrt(6.0), tolerance::by_hand(4));
  EXPECT_EQ(head["largest"], 4);
  EXPECT_EQ(head["largest_frame"], 1);
}

TEST_F(Evaluate, TableNamesEveryJoint) {
  const Outcome outcome = run({"evaluate", truth_, estimate_});

  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("FD               1.44338\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\nHip "));
  EXPECT_THAT(outcome.out, HasSubstr("\nHead "));
}

TEST_F(Evaluate, MaskAndOutliersGiveTheFiguresOfDetection) {
  Recording mask{.samples = Matrix::Zero(2, 6), .columns = {}, .frame_rate = 0, .unit = ""};
  mask.columns = {"Hip.x", "Hip.y", "Hip.z", "Head.x", "Head.y", "Head.z"};
  Recording outliers = mask;
  mask.samples(0, 0) = mask.samples(1, 1) = 1;
  outliers.samples(0, 0) = -2;
  outliers.samples(1, 4) = 0.5;

  const Outcome outcome =
      run({"evaluate", truth_, estimate_, "--json", "--mask", folder_.write("m.npy", mask),
           "--outliers", folder_.write("e.npy", outliers)});
  const nlohmann::json above =
      run({"evaluate", truth_, estimate_, "--json", "--mask", folder_ / "m.npy", "--outliers",
           folder_ / "e.npy", "--threshold", "1"})
          .json();

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json figures = outcome.json()["figures"];
  EXPECT_NEAR(figures["rmse_touched"].get<double>(), 3 / std::sqrt(2.0), tolerance::by_hand(4));
  EXPECT_NEAR(figures["rmse_untouched"].get<double>(), 4 / std::sqrt(10.0), tolerance::by_hand(4));
  EXPECT_EQ(figures["position"], (3 + 4) / 4.0);
  EXPECT_EQ(figures["precision"], 0.5);
  EXPECT_EQ(figures["recall"], 0.5);
  EXPECT_EQ(above["figures"]["precision"], 1);
  EXPECT_FALSE(figures.contains("bone_length"));
}

TEST_F(Evaluate, MeasuresBonesWhereTheTruthHasASkeleton) {
  const auto take = debian_take("01_01.bvh");
  MOCLEAN_REQUIRE_FILE(take);

  const nlohmann::json record =
      run({"evaluate", take.string(), take.string(), "--frames", "0:50", "--json"}).json();

  EXPECT_NEAR(record["figures"]["bone_length"].get<double>(), 0, tolerance::by_hand(1000));
  EXPECT_EQ(record["figures"]["acceleration"], 0);
}

TEST_F(Evaluate, OutliersNeedAMask) {
  const Outcome outcome = run({"evaluate", truth_, estimate_, "--outliers", estimate_});

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--mask"));
}

TEST_F(Evaluate, FramesCutBothFilesOfEqualLength) {
  const nlohmann::json record =
      run({"evaluate", truth_, estimate_, "--frames", "0:1", "--json"}).json();

  EXPECT_EQ(record["frames"], 1);
  EXPECT_EQ(record["largest"], 3);
}

TEST_F(Evaluate, FramesCutTheTruthToAShorterEstimate) {
  const std::string shorter = folder_ / "shorter.csv";
  ASSERT_EQ(run({"convert", estimate_, shorter, "--frames", "1:"}).exit_code, 0);

  const Outcome uncut = run({"evaluate", truth_, shorter, "--json"});
  const nlohmann::json record =
      run({"evaluate", truth_, shorter, "--frames", "1:2", "--json"}).json();

  EXPECT_EQ(uncut.exit_code, 1);
  EXPECT_THAT(uncut.err, HasSubstr("the shapes differ"));
  EXPECT_EQ(record["frames"], 1);
  EXPECT_EQ(record["largest"], 4);
}

TEST_F(Evaluate, EqualClipsHaveNoWorstJoint) {
  const nlohmann::json record = run({"evaluate", truth_, truth_, "--json"}).json();

  EXPECT_EQ(record["fd"], 0);
  EXPECT_EQ(record["changed"], 0);
  EXPECT_EQ(record["worst_joint"], "");
}

}  // namespace
}  // namespace moclean::test
