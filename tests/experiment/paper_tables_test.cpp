#include "moclean/experiment/paper_tables.hpp"

#include <gmock/gmock.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/experiment/run_cells.hpp"
#include "moclean/experiment/summary.hpp"

#include "experiment/small_experiment.hpp"

namespace moclean::test {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> labels(const PaperPart& part) {
  std::vector<std::string> found;
  for (const PaperRow& row : part.rows) found.push_back(row.label);
  return found;
}

std::string noise_of(const PaperExperiment& paper, std::size_t take) {
  return to_string(paper.experiment.noises[take].noise);
}

TEST(PaperSequences, AreFoundByTheNameOfTheTake) {
  ASSERT_NE(find_sequence("14_06"), nullptr);
  EXPECT_EQ(find_sequence("14_06")->name, "Seq3");
  EXPECT_EQ(find_sequence("14_06")->noisy_frames, 900);
  EXPECT_EQ(find_sequence("13_27")->name, "Seq2");
  EXPECT_EQ(find_sequence("14_46")->name, "Seq1");
  EXPECT_EQ(find_sequence("14_6"), nullptr);
}

TEST(PaperTables, HaveThePapersRowsForItsTakes) {
  const std::vector<ExperimentTake> takes = {small_take("14_06", 2800), small_take("14_06", 600)};

  const auto third = paper_experiment(PaperTable::segment_lengths, takes, {true, false}, {1, 2});
  const auto second = paper_experiment(PaperTable::methods, takes, {true, false}, {1, 2});

  EXPECT_EQ(noise_of(third, 0), "gaussian-frames:frames=900,mean=1,sd=1.2");
  EXPECT_EQ(noise_of(third, 1), "gaussian-frames:frames=200,mean=1,sd=1.2");
  EXPECT_THAT(labels(third.parts[0]),
              ElementsAre("none (noisy)", "200", "400", "700", "1400", "whole (rpca)"));
  EXPECT_EQ(third.parts[0].rows[2].printed, 0.2456);
  EXPECT_EQ(third.parts[0].rows[5].printed, 0.5238);
  EXPECT_THAT(labels(third.parts[1]), ElementsAre("none (noisy)", "200", "400", "whole (rpca)"));
  EXPECT_EQ(third.parts[1].rows[1].printed, std::nullopt);
  EXPECT_EQ(third.cells.size(), 2U * (6 + 4));
  EXPECT_EQ(third.cells[1].noise_seed, 2U);

  EXPECT_THAT(labels(second.parts[0]),
              ElementsAre("none (noisy)", "slra, 400 frames", "tsvd, rank 10",
                          "svt, threshold by the rule", "rpca"));
  EXPECT_EQ(second.parts[0].rows[3].printed, 0.4986);
  EXPECT_EQ(labels(second.parts[1])[1], "slra, 200 frames");
}

TEST(PaperTables, OfATinyTakeAreThoseOfTheSteps) {
  const ExperimentTake take = small_take("tiny", 60);
  ReferenceBackend backend(2);
  const auto paper = paper_experiment(PaperTable::methods, {take}, {false}, {1});

  const auto results = run_cells(paper.experiment, paper.cells, {.backend = &backend});

  const Recording noisy = corrupt(take.clip, parse_noise("gaussian-frames:frames=20"), 1).clip;
  const Matrix tsvd =
      ChainDenoiser(parse_chain("tsvd:rank=10"), &backend).denoise({&noisy, 1})[0].motion;
  ASSERT_EQ(results.size(), 5U);
  const auto fd = [&](const Matrix& motion) {
    return (motion - take.clip.samples).norm() / std::sqrt(60.0 * 30);
  };
  EXPECT_NEAR(results[0].figure("fd"), fd(noisy.samples), 1e-12);
  EXPECT_NEAR(results[2].figure("fd"), fd(tsvd), 1e-12);
  EXPECT_LT(results[1].figure("fd"), results[0].figure("fd"));
}

}  // namespace
}  // namespace moclean::test
