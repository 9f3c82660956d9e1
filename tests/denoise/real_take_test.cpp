// The whole way on real takes: file, noise, device, reference. Skipped where the takes are not.
#include <gtest/gtest.h>

#include "moclean/denoise/agreement.hpp"
#include "moclean/denoise/low_rank.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/metric/metric.hpp"
#include "moclean/noise/noise.hpp"

#include "support/backends.hpp"
#include "support/data.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

// Under the sanitizers, which slow the reference down by five, the short takes have to do.
#ifdef __SANITIZE_ADDRESS__
constexpr auto cmu_takes = {"02/02_01", "09/09_06", "16/16_22"};
#else
constexpr auto cmu_takes = {"02/02_01", "02/02_05", "05/05_12", "09/09_06", "09/09_12",
                            "14/14_06", "14/14_24", "16/16_22", "17/17_10", "49/49_18"};
#endif

struct Row {
  Index length;  // frames of a segment; 0: whole take
  double fd;     // known figure, mean over seeds
};

class PaperTable3 : public testing::TestWithParam<Row> {};

TEST_P(PaperTable3, FdOf14_06IsTheKnownFigure) {
  const auto file = test::shared_data("cmu/14/14_06.amc");
  MOCLEAN_REQUIRE_FILE(file);
  const Recording truth = excerpt(read_recording(file), 0, 2800);
  OpenClBackend backend(test::device());
  const Row row = GetParam();
  LowRankDenoiser denoiser({.whole = row.length == 0, .length = row.length}, RobustPca{}, backend);
  std::vector<Recording> noisy;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5})
    noisy.push_back(corrupt(truth, GaussianFrames{.frames = 900}, seed).clip);

  const auto cleaned = denoiser.denoise(noisy);

  double mean = 0;
  for (const Denoised& take : cleaned) mean += frobenius_distance(truth.samples, take.motion) / 5;
  EXPECT_NEAR(mean, row.fd, test::tolerance::known_figure() * row.fd);
}

INSTANTIATE_TEST_SUITE_P(SegmentLengths, PaperTable3,
                         testing::Values(Row{200, 0.113}, Row{400, 0.242}, Row{700, 0.261},
                                         Row{1400, 0.386}, Row{0, 0.515}),
                         [](const auto& parameter) {
                           return "Length" + std::to_string(parameter.param.length);
                         });

class EveryCmuTake : public testing::TestWithParam<Index> {};

TEST_P(EveryCmuTake, AgreesWithTheReference) {
  MOCLEAN_REQUIRE_FILE(test::shared_data("cmu"));
  std::vector<Recording> takes;
  for (const std::string take : cmu_takes)
    takes.push_back(read_recording(test::shared_data("cmu/" + take + ".amc")));
  OpenClBackend device(test::device());
  ReferenceBackend reference(2);
  const Segmentation segmentation{.length = GetParam()};

  const auto tested = LowRankDenoiser(segmentation, RobustPca{}, device).denoise(takes);
  const auto expected = LowRankDenoiser(segmentation, RobustPca{}, reference).denoise(takes);

  for (std::size_t i = 0; i < takes.size(); ++i) {
    SCOPED_TRACE(std::data(cmu_takes)[i]);
    const Agreement agreed = agreement(tested[i], expected[i]);
    EXPECT_LE(agreed.low_rank, low_rank_agreement_bound);
    EXPECT_LE(agreed.sparse, sparse_agreement_bound);
    EXPECT_EQ(agreed.iterations_apart, 0);
    EXPECT_EQ(agreed.ranks_apart, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(SegmentLengths, EveryCmuTake, testing::Values(25, 93, 200, 1000),
                         testing::PrintToStringParamName());

struct Cut {
  const char* take;
  Index first, last;
};

// Under the sanitizers one cut has to do.
#ifdef __SANITIZE_ADDRESS__
constexpr std::array cuts = {Cut{"14/14_06", 600, 1000}};
#else
constexpr std::array cuts = {Cut{"14/14_06", 600, 1400}, Cut{"02/02_05", 300, 1100},
                             Cut{"49/49_18", 0, 800}, Cut{"05/05_12", 200, 1000},
                             Cut{"17/17_10", 0, 800}};
#endif

TEST(TemporalRobustPca, BeatsItsFigureOnTheNoiseOfThePaper) {
  MOCLEAN_REQUIRE_FILE(test::shared_data("cmu"));
  std::vector<Recording> truths, noisy;
  for (const auto& [take, first, last] : cuts) {
    const auto file = test::shared_data(std::string("cmu/") + take + ".amc");
    truths.push_back(excerpt(read_recording(file), first, last));
    noisy.push_back(corrupt(truths.back(), GaussianFrames{.fraction = 0.3333}, 1).clip);
  }
  OpenClBackend backend(test::device());

  const auto cleaned =
      LowRankDenoiser({.length = 400}, TemporalRobustPca{}, backend).denoise(noisy);

  double mean = 0;
  for (std::size_t i = 0; i < cleaned.size(); ++i)
    mean += frobenius_distance(truths[i].samples, cleaned[i].motion) /
            static_cast<double>(cleaned.size());
  RecordProperty("mean_fd", std::to_string(mean));
  EXPECT_LE(mean, 0.020);
}

}  // namespace
}  // namespace moclean
