// moclean denoise: options, results, record, device.

#include <gmock/gmock.h>

#include "moclean/formats/read_write.hpp"

#include "cli/program.hpp"
#include "support/data.hpp"
#include "support/matrix.hpp"
#include "support/synthetic_walk.hpp"
#include "support/tolerance.hpp"

namespace moclean::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

// A walk with a jump in one joint, so that there is something to take away.
Recording disturbed_walk(Index frames) {
  Recording walk = synthetic_walk(frames);
  walk.samples.block(10, 6, 5, 3).array() += 3;
  return walk;
}

std::vector<std::string> keys(const nlohmann::json& object) {
  std::vector<std::string> names;
  for (const auto& [name, value] : object.items()) names.push_back(name);
  return names;
}

class Denoise : public ::testing::Test {
 protected:
  Outcome denoise(std::vector<std::string> options, const Start& start = {}) const {
    options.insert(options.begin(), {"denoise", input_});
    return run(options, start);
  }

  TemporaryFolder folder_;
  std::string input_ = folder_.write("walk.npy", disturbed_walk(120));
  std::string output_ = folder_ / "clean.npy";
};

TEST_F(Denoise, MotionAndOutliersAddUpToTheInput) {
  const Outcome outcome =
      denoise({"-o", output_, "--outliers", folder_ / "outliers.npy", "--segment-length", "60"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("120 frames x 93 columns, segments 2"));
  EXPECT_THAT(outcome.err, HasSubstr("changed much"));  // a walk of which a fifth is disturbed
  const Matrix motion = read_recording(output_).samples;
  const Matrix outliers = read_recording(folder_ / "outliers.npy").samples;
  const double default_tolerance = 1e-7;
  EXPECT_LE(relative_difference(motion + outliers, disturbed_walk(120).samples), default_tolerance);
  EXPECT_GT(outliers.norm(), 0);
}

TEST_F(Denoise, RecordHoldsTheWholeRun) {
  const Outcome outcome =
      denoise({"-o", output_, "--json", "-", "--segments", "3", "--rho", "1.6"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json record = outcome.json();
  EXPECT_THAT(keys(record),
              UnorderedElementsAre("version", "device", "precision", "tuning", "method", "seconds",
                                   "memory", "groups", "inputs"));
  EXPECT_EQ(record["precision"], "f64");
  EXPECT_THAT(
      keys(record["tuning"]),
      UnorderedElementsAre("tile_rows", "tile_vectors", "sweep_rows", "panel", "form", "products",
                           "eigen", "batch_segments", "queues", "work_group", "file"));
  EXPECT_EQ(record["version"], MOCLEAN_VERSION);
  EXPECT_THAT(record["device"].get<std::string>(), HasSubstr("opencl"));
  const nlohmann::json& method = record["method"];
  EXPECT_THAT(
      keys(method),
      UnorderedElementsAre("name", "specification", "segmentation", "lambda", "lambda_scale", "rho",
                           "mu0_factor", "mu_max_factor", "tolerance", "max_iterations", "order"));
  EXPECT_EQ(method["name"], "slra");
  EXPECT_EQ(method["specification"],
            "slra:lambda=0,lambda-scale=1,rho=1.6,tolerance=1e-07,max-iterations=1000,order=ae,"
            "segments=3");
  EXPECT_EQ(method["segmentation"]["segments"], 3);
  EXPECT_EQ(method["lambda"], nullptr);
  EXPECT_EQ(method["rho"], 1.6);
  EXPECT_EQ(method["tolerance"], 1e-7);
  EXPECT_EQ(method["order"], "ae");
  ASSERT_EQ(record["inputs"].size(), 1);
}

TEST_F(Denoise, RecordStatesTimeAndMemoryOfTheRun) {
  const Outcome outcome = denoise({"-o", output_, "--json", "-", "--memory-limit", "64M"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json record = outcome.json();
  EXPECT_THAT(keys(record["seconds"]), UnorderedElementsAre("read", "solve", "write", "total"));
  for (const auto& [stage, seconds] : record["seconds"].items()) {
    EXPECT_GT(seconds.get<double>(), 0) << stage;
    EXPECT_LE(seconds, record["seconds"]["total"]) << stage;
  }
  EXPECT_THAT(keys(record["memory"]), UnorderedElementsAre("limit", "peak"));
  EXPECT_EQ(record["memory"]["limit"], 64 << 20);
  EXPECT_GT(record["memory"]["peak"], 1 << 20);
  EXPECT_EQ(record["groups"], 1);
}

TEST_F(Denoise, RecordingBeyondTheMemoryLimitIsNamed) {
  const Outcome outcome = denoise({"-o", output_, "--method", "slra", "--memory-limit", "512K"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr(input_ + ": needs 610.3 KiB of memory, but --memory-limit "
                                              "leaves 384 KiB for recordings"));
  EXPECT_THAT(folder_.names(), ElementsAre("walk.npy"));
}

TEST_F(Denoise, RecordDescribesEverySegmentOfAnInput) {
  const Outcome outcome = denoise({"-o", output_, "--json", "-", "--segments", "3"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json input = outcome.json()["inputs"][0];
  EXPECT_THAT(keys(input),
              UnorderedElementsAre("file", "frames", "columns", "layout", "seconds",
                                   "frames_per_second", "samples", "changed", "segments"));
  EXPECT_THAT(keys(input["changed"]), UnorderedElementsAre("corrected", "filled", "largest"));
  const auto& samples = input["samples"];
  EXPECT_EQ(samples["kept"].get<int>() + samples["corrected"].get<int>(), 120 * 93);
  EXPECT_EQ(samples["filled"].get<int>() + samples["missing"].get<int>(), 0);
  EXPECT_EQ(input["file"], input_);
  EXPECT_EQ(input["frames"], 120);
  EXPECT_EQ(input["columns"], 93);
  EXPECT_THAT(keys(input["seconds"]), UnorderedElementsAre("read", "solve", "write"));
  const double seconds = input["seconds"]["solve"];
  EXPECT_NEAR(input["frames_per_second"].get<double>() * seconds, 120, tolerance::by_hand(120));
  ASSERT_EQ(input["segments"].size(), 3);
  for (int s = 0; s < 3; ++s) {
    const nlohmann::json& segment = input["segments"][static_cast<std::size_t>(s)];
    EXPECT_THAT(keys(segment), UnorderedElementsAre("first_frame", "frames", "iterations", "rank",
                                                    "residual", "converged"));
    EXPECT_EQ(segment["first_frame"], 40 * s);
    EXPECT_EQ(segment["frames"], 40);
    EXPECT_EQ(segment["converged"], true);
    EXPECT_LE(segment["residual"].get<double>(), 1e-7);
  }
}

TEST_F(Denoise, RpcaTakesTheWholeRecording) {
  const Outcome outcome =
      denoise({"-o", output_, "--method", "rpca", "--json", folder_ / "r.json"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto record = nlohmann::json::parse(content(folder_ / "r.json"));
  EXPECT_EQ(record["method"]["name"], "rpca");
  EXPECT_EQ(record["method"]["segmentation"]["whole"], true);
  EXPECT_EQ(record["inputs"][0]["segments"].size(), 1);
}

TEST_F(Denoise, EveryBackendFormAndProductPathGivesTheSameMotion) {
  const std::vector<std::vector<std::string>> ways = {{"--backend", "reference"},
                                                      {"--backend", "opencl", "--products", "own"},
                                                      {"--form", "cpu", "--products", "clblast"},
                                                      {"--form", "gpu"}};
  std::vector<Matrix> motions;
  for (std::vector<std::string> way : ways) {
    way.insert(way.end(), {"-o", output_, "--quiet"});
    const Outcome outcome = denoise(way);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, IsEmpty());
    motions.push_back(read_recording(output_).samples);
  }

  for (std::size_t i = 1; i < motions.size(); ++i)
    EXPECT_LE(relative_difference(motions[i], motions[0]), tolerance::backends_low_rank()) << i;
}

TEST_F(Denoise, FormAndProductsAreRecordedInBothSpellings) {
  struct Case {
    std::vector<std::string> options;
    const char *form, *products;
  };
  const Case cases[] = {{{"--form", "cpu"}, "cpu", "own"},
                        {{"--form", "gpu"}, "gpu", "own"},
                        {{"--products", "group"}, "gpu", "own"},
                        {{"--form", "gpu", "--products", "group"}, "gpu", "own"},
                        {{"--form", "gpu", "--products", "own"}, "gpu", "own"},
                        {{"--form", "cpu", "--products", "clblast"}, "cpu", "clblast"},
                        {{"--products", "clblast", "--form", "gpu"}, "gpu", "clblast"}};
  for (const Case& c : cases) {
    std::vector<std::string> options = {"-o", output_, "--json", "-", "--no-tuning"};
    options.insert(options.end(), c.options.begin(), c.options.end());

    const Outcome outcome = denoise(options);

    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.json()["tuning"]["form"], c.form) << c.options[1];
    EXPECT_EQ(outcome.json()["tuning"]["products"], c.products) << c.options[1];
  }
}

TEST_F(Denoise, ParametersReachTheSolver) {
  ASSERT_EQ(denoise({"-o", output_}).exit_code, 0);
  const std::string defaults = content(output_);
  const std::vector<std::vector<std::string>> changes = {
      {"--lambda", "0.2"},       {"--lambda-scale", "2"}, {"--rho", "1.3"},
      {"--tolerance", "0.0001"}, {"--order", "ea"},       {"--segments", "2"},
      {"--segment-length", "30"}};
  for (std::vector<std::string> change : changes) {
    change.insert(change.end(), {"-o", output_, "--backend", "opencl"});

    const Outcome outcome = denoise(change);

    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(content(output_) != defaults) << change[0];
  }
}

TEST_F(Denoise, UnconvergedRunWritesItsResultAndExits3) {
  const Outcome outcome = denoise({"-o", output_, "--max-iterations", "5", "--json", "-"});

  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("1 of 1 segments did not converge"));
  EXPECT_EQ(outcome.json()["inputs"][0]["segments"][0]["converged"], false);
  EXPECT_EQ(read_recording(output_).frames(), 120);
}

TEST_F(Denoise, VerifyAddsTheAgreementToTheRecord) {
  const Outcome outcome = denoise({"-o", output_, "--verify", "--json", folder_ / "record.json"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("difference to the reference"));
  const auto record = nlohmann::json::parse(content(folder_ / "record.json"));
  const nlohmann::json& agreement = record["inputs"][0]["agreement"];
  EXPECT_THAT(keys(agreement), UnorderedElementsAre("low_rank", "sparse", "largest_difference",
                                                    "same_iterations", "same_rank"));
  EXPECT_LE(agreement["low_rank"].get<double>(), tolerance::backends_low_rank());
  EXPECT_EQ(agreement["same_rank"], true);
}

TEST_F(Denoise, VerifyPassesOnARealTake) {
  const auto take = debian_take("01_01.bvh");
  MOCLEAN_REQUIRE_FILE(take);

  const Outcome outcome = run({"denoise", take.string(), "-o", output_, "--frames", "0:1000",
                               "--segment-length", "93", "--verify"});

  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST_F(Denoise, UnknownDeviceFailsAndListsWhatThereIs) {
  const nlohmann::json devices = run({"devices", "--json"}).json();
  if (devices.empty()) GTEST_SKIP() << "no OpenCL device";
  const auto name = devices[0]["name"].get<std::string>();

  const Outcome by_option = denoise({"-o", output_, "--device", "abacus"});
  const Outcome by_environment = denoise({"-o", output_}, {.device = "abacus"});

  for (const Outcome& outcome : {by_option, by_environment}) {
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.err, HasSubstr("no OpenCL device matches 'abacus' (found: "));
    EXPECT_THAT(outcome.err, HasSubstr(name));
  }
  EXPECT_THAT(folder_.names(), ElementsAre("walk.npy"));
}

TEST_F(Denoise, OptionOverrulesTheEnvironment) {
  EXPECT_EQ(denoise({"-o", output_, "--device", "0:0"}, {.device = "abacus"}).exit_code, 0);
}

TEST_F(Denoise, SegmentBeyondTheDevicesShareIsNamed) {
  const std::string walk = folder_.write("long.npy", synthetic_walk(2000));

  const Outcome outcome =
      run({"denoise", walk, "-o", output_, "--method", "rpca", "--memory-limit", "16M"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr(walk + ": a segment of 2000 frames x 93 columns needs"));
  EXPECT_THAT(outcome.err, HasSubstr("more than the 4 MiB usable"));
  EXPECT_THAT(folder_.names(), ElementsAre("long.npy", "walk.npy"));
}

struct WrongOptions {
  const char* name;
  std::vector<std::string> options;
  const char* message;
};

void PrintTo(const WrongOptions& wrong, std::ostream* out) { *out << wrong.name; }

class WrongDenoiseOptions : public ::testing::TestWithParam<WrongOptions> {};

TEST_P(WrongDenoiseOptions, AreAUsageErrorAndWriteNothing) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"denoise", folder.write("walk.csv", synthetic_walk(10)),
                                        "-o", folder / "clean.npy"};
  const auto& options = GetParam().options;
  arguments.insert(arguments.end(), options.begin(), options.end());

  const Outcome outcome = run(arguments);

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr(GetParam().message));
  EXPECT_THAT(folder.names(), ElementsAre("walk.csv"));
}

INSTANTIATE_TEST_SUITE_P(
    Options, WrongDenoiseOptions,
    ::testing::Values(
        WrongOptions{"Unknown", {"--smooth"}, "--smooth"},
        WrongOptions{"Misspelt", {"--segmnets", "2"}, "--segmnets; did you mean '--segments'?"},
        WrongOptions{"Method", {"--method", "pca"}, "unknown method 'pca'"},
        WrongOptions{"MisspeltStep", {"--method", "hampel+medain"}, "did you mean 'median'?"},
        WrongOptions{"MisspeltFormat", {"--format", "bvg"}, "did you mean 'bvh'?"},
        WrongOptions{"Order", {"--order", "xy"}, "--order"},
        WrongOptions{"Backend", {"--backend", "cuda"}, "--backend"},
        WrongOptions{"Products", {"--products", "blas"}, "--products"},
        WrongOptions{"Form", {"--form", "group"}, "--form"},
        WrongOptions{"FormTwice", {"--products", "group", "--form", "cpu"}, "means --form gpu"},
        WrongOptions{
            "MixedForm", {"--form", "gpu", "--precision", "mixed"}, "works with --form cpu only"},
        WrongOptions{"NotANumber", {"--rho", "fast"}, "--rho"},
        WrongOptions{"Iterations", {"--max-iterations", "0"}, "max-iterations"},
        WrongOptions{"NoSegments", {"--segments", "0"}, "--segments: must be positive, found '0'"},
        WrongOptions{"NoLength", {"--segment-length", "-3"}, "must be positive, found '-3'"},
        WrongOptions{"TwoSegmentations", {"--segments", "2", "--segment-length", "5"}, "excludes"},
        WrongOptions{"NegativeOverlap", {"--overlap", "-1"}, "must not be negative, found '-1'"},
        WrongOptions{"OverlapText", {"--overlap", "2.5"}, "--overlap: must be a whole number"},
        WrongOptions{"RpcaOverlap", {"--method", "rpca", "--overlap", "9"}, "--overlap is that of"},
        WrongOptions{"TsvdOverlap", {"--method", "tsvd", "--overlap", "9"}, "--overlap is that of"},
        WrongOptions{"KeyOverlap", {"--method", "svt:overlap=9"}, "overlap needs segment-length"},
        WrongOptions{"Segment", {"--segment", "some"}, "--segment"},
        WrongOptions{"RpcaAuto", {"--method", "rpca", "--segment", "auto"}, "--method slra"},
        WrongOptions{"TsvdAuto", {"--method", "tsvd", "--segment", "auto"}, "--method slra"},
        WrongOptions{"TwoLambdas", {"--lambda", "1", "--lambda-scale", "2"}, "excludes"},
        WrongOptions{"RpcaSegments", {"--method", "rpca", "--segments", "2"}, "--method slra"},
        WrongOptions{"RpcaLength", {"--segment-length", "9", "--method", "rpca"}, "--method slra"},
        WrongOptions{"MethodKey", {"--method", "hampel:width=3"}, "expected one of window, sigmas"},
        WrongOptions{"FilterSegments", {"--method", "median", "--segments", "2"}, "--method slra"},
        WrongOptions{"FilterLambda", {"--method", "median", "--lambda", "2"}, "--method slra and"},
        WrongOptions{"TsvdTolerance", {"--method", "tsvd", "--tolerance", "1e-3"}, "--method slra"},
        WrongOptions{
            "FilterVerify", {"--method", "median", "--verify"}, "needs a method that runs"},
        WrongOptions{
            "FilterProfile", {"--method", "median", "--profile"}, "needs a method that runs"},
        WrongOptions{"TsvdMixed", {"--method", "tsvd", "--precision", "mixed"}, "f64) only"},
        WrongOptions{"CutOff", {"--method", "butterworth:cutoff=60"}, "half the frame rate"},
        WrongOptions{"Jobs", {"--jobs", "0"}, "--jobs: must be positive, found '0'"},
        WrongOptions{
            "ManyJobs", {"--jobs", "99999999999999999999"}, "--jobs: must be at most 4096"},
        WrongOptions{"Lambda", {"--lambda", "-1e999"}, "--lambda: must be positive"},
        WrongOptions{"LargeLambda", {"--lambda", "1e999"}, "--lambda: is too large"},
        WrongOptions{"Rate", {"--rate", "0"}, "--rate: must be positive, found '0'"},
        WrongOptions{"LargeRate", {"--rate", "1e300"}, "--rate: must be 1e-06 to 1000000"},
        WrongOptions{"InfiniteRate", {"--rate", "inf"}, "--rate: must be 1e-06 to 1000000"},
        WrongOptions{
            "MissingText", {"--missing", "abc"}, "--missing: must be a number, found 'abc'"},
        WrongOptions{
            "InfiniteMissing", {"--missing", "1e999"}, "--missing: is too large, found '1e999'"},
        WrongOptions{
            "ScaleText", {"--lambda-scale", "x"}, "--lambda-scale: must be a number, found 'x'"},
        WrongOptions{"Tolerance", {"--tolerance", "0"}, "--tolerance: must be positive, found '0'"},
        WrongOptions{"Rho", {"--rho", "1"}, "--rho: must be above 1, found '1'"},
        WrongOptions{"RhoText", {"--rho", "1,5"}, "--rho: must be a number, found '1,5'"},
        WrongOptions{
            "EndlessFrames",
            {"--frames", "0:99999999999999999999"},
            "--frames is '0:99999999999999999999', expected A:B with whole numbers from 0, "
            "for instance 0:2800; 99999999999999999999 is too large"},
        WrongOptions{"TruthFrames",
                     {"--truth", "x.csv", "--truth-frames", "7"},
                     "--truth-frames is '7', expected A:B"},
        WrongOptions{"MemoryText", {"--memory-limit", "lots"}, "--memory-limit is 'lots'"},
        WrongOptions{"MemoryZero", {"--memory-limit", "0"}, "--memory-limit is '0'"},
        WrongOptions{"MemoryUnit", {"--memory-limit", "2X"}, "such as 512M or 2G"},
        WrongOptions{"FramesText", {"--frames", "1-5"}, "expected A:B"},
        WrongOptions{"FramesNegative", {"--frames", ":-5"}, "expected A:B"},
        WrongOptions{"FramesEmpty", {"--frames", "5:5"}, "holds no frame"},
        WrongOptions{"FramesBeyond", {"--frames", "5:11"}, "walk.csv has 10 frames"},
        WrongOptions{"FramesFromBeyond", {"--frames", "10:"}, "walk.csv has 10 frames"},
        WrongOptions{"Format", {"--format", "csv"}, "--format csv contradicts"},
        WrongOptions{"OutliersFormat",
                     {"--outliers", "e.text"},
                     "expected .bvh, .amc, .c3d, .trc, .csv, .tsv, .txt, .mot, .sto, .npy or .npz"},
        WrongOptions{"MaskFormat",
                     {"--mask", "m.text"},
                     "expected .bvh, .amc, .c3d, .trc, .csv, .tsv, .txt, .mot, .sto, .npy or .npz"},
        WrongOptions{"GapNegative", {"--max-gap", "-1"}, "--max-gap: must not be negative"},
        WrongOptions{"GapText", {"--max-gap", "long"}, "--max-gap: must be a number"},
        WrongOptions{"Sigma", {"--sigma", "s.npy", "--method", "slra"}, "--sigma: method slra:"},
        WrongOptions{"SigmaOfFilter", {"--method", "median", "--sigma", "s.npy"}, "method median:"},
        WrongOptions{"VerifyReference", {"--verify", "--backend", "reference"}, "--verify"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace moclean::test
