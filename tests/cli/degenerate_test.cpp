// Takes and parameters at the ends of what numbers can be: an answer, or an error that names the
// take; never NaN or zeros without a word.

#include <gmock/gmock.h>

#include "moclean/formats/read_write.hpp"

#include "cli/batch_folder.hpp"

namespace moclean::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Degenerate : public ::testing::Test {
 protected:
  // Of a walk times a number.
  std::string scaled(const std::string& name, double factor) const {
    Recording walk = small_walk(60);
    walk.samples *= factor;
    return folder_.write(name, walk);
  }

  Outcome denoise(const std::string& input, const std::string& method) const {
    return run({"denoise", input, "-o", folder_ / "out.npy", "--method", method, "--rate", "120",
                "--backend", "reference", "--quiet"});
  }

  TemporaryFolder folder_;
};

TEST_F(Degenerate, ParametersThatMakeNoNumberAreAFailureOfTheTake) {
  const std::string walk = scaled("walk.npy", 1e135);  // beside which such deviations are 0

  const Outcome outcome = denoise(walk, "kalman:process=1e-100,measurement=1e-100");

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("walk.npy: kalman:"), HasSubstr("makes no number"),
                                 HasSubstr("frame ")));
  EXPECT_THAT(folder_.names(), ElementsAre("walk.npy"));
}

TEST_F(Degenerate, ParametersOutOfRangeAreRefusedWithTheRange) {
  const std::string walk = scaled("walk.npy", 1);
  for (const auto& [method, message] :
       {std::pair{"whittaker:lambda=1e16", "expected a positive number up to 10000000000"},
        {"whittaker-l1:lambda=1e16", "expected a positive number up to 10000000000"},
        {"kalman:process=1e160", "expected a number from 1e-100 to 1e+100"},
        {"moving-average:window=2147483647", "expected an odd number of frames up to 9999"},
        {"hampel:window=2147483647", "expected an odd number of frames up to 9999"},
        {"gaussian:sd=1e9", "expected a positive number of frames up to 1000"},
        {"butterworth:cutoff=1e-300", "expected at least 1e-05 of the frame rate"}}) {
    const Outcome outcome = denoise(walk, method);

    EXPECT_NE(outcome.exit_code, 0) << method;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  }
}

TEST_F(Degenerate, SamplesTooSmallToBeSquaredAreRefusedByMatrixMethods) {
  const std::string tiny = scaled("tiny.npy", 1e-300);
  for (const char* method : {"slra", "rpca", "tsvd", "svt", "completion", "tslra"}) {
    const Outcome outcome = denoise(tiny, method);

    EXPECT_EQ(outcome.exit_code, 1) << method;
    EXPECT_THAT(outcome.err, HasSubstr("tiny.npy: has no sample larger than"));
    EXPECT_THAT(outcome.err, HasSubstr("another unit"));
  }
}

TEST_F(Degenerate, SamplesOfAnySizeAreFilteredAlike) {
  ASSERT_EQ(denoise(scaled("walk.npy", 1), "kalman").exit_code, 0);
  const Matrix expected = read_recording(folder_ / "out.npy").samples;
  for (const double factor : {0x1p-900, 0x1p400}) {
    const Outcome outcome = denoise(scaled("scaled.npy", factor), "kalman");

    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const Matrix found = read_recording(folder_ / "out.npy").samples / factor;
    EXPECT_TRUE((found.array() == expected.array()).all()) << factor;
  }
}

TEST_F(Degenerate, ATakeOfABatchIsNamedAndTheOthersAreCleaned) {
  folder_.write("in/a.csv", small_walk(60));
  Recording tiny = small_walk(60), zeros = tiny;
  tiny.samples *= 1e-300;
  zeros.samples.setZero();
  folder_.write("in/tiny.csv", tiny);
  folder_.write("in/zeros.csv", zeros);

  const Outcome outcome = run({"denoise", folder_ / "in", "-o", folder_ / "out", "--method", "slra",
                               "--backend", "reference"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("tiny.csv: has no sample larger"));
  EXPECT_THAT(files_below(folder_, "out"),
              ElementsAre("a.csv", "moclean.manifest.jsonl", "zeros.csv"));
  EXPECT_TRUE(read_recording(folder_ / "out/zeros.csv").samples.isZero(0));
}

}  // namespace
}  // namespace moclean::test
