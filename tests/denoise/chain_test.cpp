#include "moclean/denoise/chain.hpp"

#include <gmock/gmock.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/metric/metric.hpp"
#include "moclean/noise/noise.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean {
namespace {

using test::nan;
using testing::HasSubstr;
using testing::ThrowsMessage;

Recording noisy_walk(Index frames) {
  return corrupt(test::synthetic_walk(frames), GaussianFrames{.fraction = 0.3}, 1).clip;
}

Denoised run(std::string_view chain, const Recording& take, const Monitor& monitor = {}) {
  ReferenceBackend backend(2);
  return ChainDenoiser(parse_chain(chain), &backend, 2).denoise({&take, 1}, monitor).at(0);
}

void expect_refused(std::string_view chain, const std::string& message) {
  EXPECT_THAT([&] { parse_chain(chain); }, ThrowsMessage<ArgumentError>(message)) << chain;
}

TEST(ParseChain, ReadsEveryStep) {
  const Chain chain = parse_chain("hampel:window=9+slra:segment-length=100,lambda=0.2+butterworth");

  ASSERT_EQ(chain.size(), 3u);
  EXPECT_EQ(chain[0], Step(Filter(Hampel{.window = 9})));
  EXPECT_EQ(chain[1], Step(LowRank{{.length = 100}, RobustPca{.lambda = 0.2}}));
  EXPECT_EQ(chain[2], Step(Filter(Butterworth{})));
}

TEST(ParseChain, KnowsEveryName) {
  for (const std::string_view name : step_names())
    EXPECT_EQ(name_of(parse_chain(name).at(0)), name);
}

TEST(ParseChain, CutsOnlySlraByDefault) {
  EXPECT_EQ(parse_chain("slra")[0], Step(LowRank{{.length = 200}, RobustPca{}}));
  EXPECT_EQ(parse_chain("rpca")[0], Step(LowRank{{.whole = true}, RobustPca{}}));
  EXPECT_EQ(parse_chain("tsvd")[0], Step(LowRank{{.whole = true}, TruncatedSvd{}}));
  EXPECT_EQ(parse_chain("svt:segments=3")[0],
            Step(LowRank{{.segments = 3}, SingularValueThresholding{}}));
}

TEST(ParseChain, ReadsTheOverlapOfSegments) {
  EXPECT_EQ(parse_chain("slra:overlap=20")[0],
            Step(LowRank{{.length = 200, .overlap = 20}, RobustPca{}}));
  EXPECT_EQ(parse_chain("tsvd:rank=4,segments=3,overlap=9")[0],
            Step(LowRank{{.segments = 3, .overlap = 9}, TruncatedSvd{.rank = 4}}));
  const std::string text = "tsvd:rank=4,segments=3,overlap=9";
  EXPECT_EQ(to_string(parse_chain(text)), text);
  expect_refused("tsvd:overlap=9", "overlap needs segment-length or segments");
}

TEST(ParseChain, ReadsAutomaticSegmentsOfSlra) {
  const Step automatic = LowRank{{.segments = 3, .cheapest = true}, RobustPca{}};

  EXPECT_EQ(parse_chain("slra:segments=3,segment=auto")[0], automatic);
  EXPECT_EQ(parse_chain("slra:segments=3", {.automatic = true})[0], automatic);
  EXPECT_EQ(parse_chain(to_string(automatic))[0], automatic);
  EXPECT_EQ(parse_chain("slra:segment=equal", {.automatic = true})[0], Step(LowRank{}));
  EXPECT_EQ(parse_chain("tsvd:segments=3", {.automatic = true})[0],
            Step(LowRank{{.segments = 3}, TruncatedSvd{}}));
  expect_refused("tsvd:segments=3,segment=auto",
                 "method tsvd: unknown key 'segment', expected one of rank, segment-length, "
                 "segments, overlap");
}

TEST(ParseChain, GivesTheDefaultOverlapToMethodsThatCut) {
  const StepDefaults defaults{.overlap = 12};

  EXPECT_EQ(parse_chain("slra:segments=2", defaults)[0],
            Step(LowRank{{.segments = 2, .overlap = 12}, RobustPca{}}));
  EXPECT_EQ(parse_chain("slra:overlap=0", defaults)[0], Step(LowRank{}));
  EXPECT_EQ(parse_chain("tsvd", defaults)[0], Step(LowRank{{.whole = true}, TruncatedSvd{}}));
  EXPECT_EQ(parse_chain("rpca", defaults)[0], Step(LowRank{{.whole = true}, RobustPca{}}));
}

TEST(ParseChain, FillsInTheDefaultsOfItsCaller) {
  const StepDefaults defaults{.robust_pca = {.rho = 1.7},
                              .segmentation = Segmentation{.length = 50}};

  EXPECT_EQ(parse_chain("slra:lambda=1", defaults)[0],
            Step(LowRank{{.length = 50}, RobustPca{.lambda = 1, .rho = 1.7}}));
  EXPECT_EQ(parse_chain("tsvd", defaults)[0], Step(LowRank{{.length = 50}, TruncatedSvd{}}));
  EXPECT_EQ(parse_chain("rpca", defaults)[0],
            Step(LowRank{{.whole = true}, RobustPca{.rho = 1.7}}));
}

TEST(ParseChain, ReadsBackWhatToStringWrites) {
  for (const std::string_view name : step_names()) {
    const Chain chain = parse_chain(name);
    EXPECT_EQ(parse_chain(to_string(chain)), chain) << to_string(chain);
  }
  const std::string text = "tsvd:rank=4,segments=3+median:window=5";
  EXPECT_EQ(to_string(parse_chain(text)), text);
}

TEST(ParseChain, CutsTslraIntoSegmentsOf400FramesUnlessTold) {
  const auto step_of = [](const char* text) {
    return std::get<LowRank>(parse_chain(text).front());
  };

  EXPECT_EQ(step_of("tslra").segmentation, (Segmentation{.length = 400}));
  EXPECT_EQ(step_of("tslra:segments=3,gamma=2").segmentation, (Segmentation{.segments = 3}));
  EXPECT_EQ(std::get<TemporalRobustPca>(step_of("tslra:segments=3,gamma=2").method).gamma, 2);
  EXPECT_EQ(to_string(parse_chain("tslra:nu=0.5")),
            "tslra:gamma=0,nu=0.5,lambda=0,lambda-scale=1,rho=1.1,tolerance=1e-06,"
            "max-iterations=1000,segment-length=400");
}

TEST(ParseChain, NamesWhatIsWrongAndWhatWouldBeRight) {
  expect_refused(
      "pca",
      "unknown method 'pca', expected one of auto, slra, rpca, tsvd, svt, completion, tslra, "
      "moving-average, gaussian, median, hampel, butterworth, savitzky-golay, whittaker, "
      "whittaker-l1, gcv, kalman, interpolate, none");
  expect_refused(
      "median+",
      "unknown method '', expected one of auto, slra, rpca, tsvd, svt, completion, tslra, "
      "moving-average, gaussian, median, hampel, butterworth, "
      "savitzky-golay, whittaker, whittaker-l1, gcv, kalman, interpolate, none");
  expect_refused("hampel:width=7",
                 "method hampel: unknown key 'width', expected one of window, sigmas");
  expect_refused("tsvd:rank=0", "rank is 0, expected at least 1");
  expect_refused("rpca:segments=2",
                 "method rpca: unknown key 'segments', expected one of lambda, lambda-scale, rho, "
                 "tolerance, max-iterations, order");
  expect_refused("slra:segments=2,segment-length=9",
                 "segment-length and segments exclude each other");
  expect_refused("svt:segments=0", "segment-length and segments are expected to be at least 1");
}

TEST(ChainDenoiser, OfOneMatrixMethodIsThatMethod) {
  const Recording take = noisy_walk(80);
  ReferenceBackend backend;
  LowRankDenoiser plain({.length = 40}, RobustPca{}, backend);

  const Denoised expected = plain.denoise({&take, 1}).at(0);
  const Denoised result = run("slra:segment-length=40", take);

  EXPECT_TRUE(test::same_bits(result.motion, expected.motion));
  EXPECT_TRUE(test::same_bits(result.outliers, expected.outliers));
  EXPECT_EQ(result.segments.size(), 2u);
}

TEST(ChainDenoiser, RunsItsStepsOneAfterTheOther) {
  const Recording take = noisy_walk(80);

  const Denoised result = run("hampel+tsvd:rank=6+butterworth:cutoff=10", take);

  const Recording first = like(take, filtered(take, Hampel{}));
  const Recording second = like(take, run("tsvd:rank=6", first).motion);
  const Matrix third = filtered(second, Butterworth{.cutoff = 10});
  EXPECT_TRUE(test::same_bits(result.motion, third));
  EXPECT_TRUE(test::same_bits(result.outliers, Matrix(take.samples - third)));
  ASSERT_EQ(result.segments.size(), 1u);
  EXPECT_EQ(result.segments[0].outcome.rank, 6);
}

TEST(ChainDenoiser, OfFiltersNeedsNoBackendAndKeepsGaps) {
  Recording take = noisy_walk(60);
  take.samples.block(10, 3, 9, 3).setConstant(nan);

  ChainDenoiser denoiser(parse_chain("hampel+median"), nullptr);
  const Denoised result = denoiser.denoise({&take, 1}).at(0);

  EXPECT_TRUE(result.segments.empty());
  EXPECT_TRUE((result.motion.array().isNaN() == take.samples.array().isNaN()).all());
  EXPECT_TRUE(result.outliers.allFinite());
  EXPECT_EQ(result.outliers.block(10, 3, 9, 3).norm(), 0);
}

TEST(ChainDenoiser, CompletesWhatIsMissing) {
  const Recording walk = test::synthetic_walk(120);
  const Recording take = corrupt(walk, Gap{.runs = {.count = 3, .length = 20}}, 1).clip;

  const Denoised result = run("completion", take);

  EXPECT_TRUE(result.motion.allFinite());
  EXPECT_LT(frobenius_distance(walk.samples, result.motion), 0.5);
  EXPECT_THROW(run("tsvd", take), ShapeError);
  EXPECT_THROW(run("median+tsvd", take), ShapeError);
  EXPECT_NO_THROW(run("median+completion+slra", take));
  const Denoised smooth = run("median+tslra:tolerance=1e-3", take);
  EXPECT_TRUE(smooth.motion.allFinite());
  EXPECT_LT(frobenius_distance(walk.samples, smooth.motion), 0.5);
}

TEST(ChainDenoiser, InterpolatesForMethodsThatNeedEverySample) {
  Recording take = noisy_walk(60);
  take.samples.block(10, 3, 9, 3).setConstant(nan);

  const Denoised result = run("interpolate+tsvd:rank=6", take);

  const Recording whole = like(take, filtered(take, Interpolate{}));
  EXPECT_TRUE(whole.samples.allFinite());
  EXPECT_TRUE(test::same_bits(result.motion, run("tsvd:rank=6", whole).motion));
  EXPECT_TRUE(result.outliers.allFinite());
  EXPECT_EQ(result.outliers.block(10, 3, 9, 3).norm(), 0);
}

TEST(ChainDenoiser, CountsTheSegmentsOfAllItsMethods) {
  const Recording take = noisy_walk(80);
  std::vector<Progress> reports;

  run("tsvd:segments=4+median+svt:segments=2", take,
      {.report = [&](const Progress& p) { reports.push_back(p); }, .stop = {}});

  ASSERT_FALSE(reports.empty());
  EXPECT_EQ(reports.back().finished, 6);
  for (std::size_t i = 0; i < reports.size(); ++i) {
    EXPECT_EQ(reports[i].total, 6);
    if (i > 0) {
      EXPECT_GT(reports[i].finished, reports[i - 1].finished);
    }
  }
}

TEST(ChainDenoiser, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();

  EXPECT_THROW(run("median", noisy_walk(20), {.report = {}, .stop = stop.get_token()}), Cancelled);
}

TEST(ChainDenoiser, RefusesWhatItCannotRun) {
  Recording take = noisy_walk(20);
  take.frame_rate = 0;

  EXPECT_THAT([&] { run("butterworth", take); },
              ThrowsMessage<ArgumentError>(HasSubstr("butterworth needs the frame rate")));
  EXPECT_THROW(ChainDenoiser(parse_chain("slra"), nullptr), ArgumentError);
  EXPECT_THROW(ChainDenoiser(Chain{}, nullptr), ArgumentError);
}

TEST(Chains, SayWhatTheyNeed) {
  EXPECT_TRUE(accepts_missing(parse_chain("hampel+median")));
  EXPECT_TRUE(accepts_missing(parse_chain("hampel+completion+slra")));
  EXPECT_FALSE(accepts_missing(parse_chain("hampel+tsvd+completion")));
  EXPECT_FALSE(accepts_missing(parse_chain("tsvd+interpolate")));
  EXPECT_TRUE(accepts_missing(parse_chain("hampel+interpolate+tsvd")));
  EXPECT_EQ(needs_frame_rate(parse_chain("slra+kalman+butterworth")), "kalman");
  EXPECT_EQ(needs_frame_rate(parse_chain("slra+median")), "");
  EXPECT_FALSE(needs_backend(parse_chain("hampel+median")));
  EXPECT_TRUE(needs_backend(parse_chain("hampel+tsvd")));
}

}  // namespace
}  // namespace moclean
