#include "moclean/experiment/run_cells.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/metric/metric.hpp"

#include "experiment/small_experiment.hpp"
#include "formats/temporary_folder.hpp"

namespace moclean::test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Everything but the time.
void expect_same(const CellResult& found, const CellResult& expected) {
  auto figures = expected.figures;
  for (const auto& [name, value] : found.figures) {
    ASSERT_EQ(figures.count(name), 1U) << name;
    if (name == "seconds" || (std::isnan(value) && std::isnan(figures[name]))) continue;
    EXPECT_EQ(value, figures[name]) << name;
  }
  EXPECT_EQ(found.figures.size(), figures.size());
  EXPECT_EQ(found.refused, expected.refused);
  EXPECT_EQ(found.frames, expected.frames);
}

class RunCells : public ::testing::Test {
 protected:
  std::vector<CellResult> run(CellRun more = {}) {
    more.backend = &backend_;
    return run_cells(experiment_, all_cells(experiment_), more);
  }

  Experiment experiment_ = small_experiment();
  ReferenceBackend backend_{2};
};

TEST_F(RunCells, GiveWhatTheStepsGiveByHand) {
  const std::vector<Cell> cells = all_cells(experiment_);
  const std::vector<CellResult> results = run();

  ASSERT_EQ(results.size(), 2U * 2 * 4 * 2);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Recording& truth = experiment_.takes[cells[i].take].clip;
    if (cells[i].noise != 0 || cells[i].method != 2) continue;  // slra
    const Corrupted noisy = corrupt(truth, experiment_.noises[0].noise, cells[i].noise_seed);
    const Denoised clean =
        ChainDenoiser(parse_chain("slra:segments=2"), &backend_).denoise({&noisy.clip, 1}).front();
    EXPECT_EQ(results[i].figure("fd"), frobenius_distance(truth.samples, clean.motion));
    EXPECT_LT(results[i].figure("fd"), frobenius_distance(truth.samples, noisy.clip.samples));
    EXPECT_GT(results[i].figure("recall"), 0.9);
    EXPECT_EQ(results[i].figure("missing"), 0);
  }
}

TEST_F(RunCells, RefuseMissingSamplesCellByCell) {
  const std::vector<Cell> cells = all_cells(experiment_);
  const std::vector<CellResult> results = run();

  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool gaps = cells[i].noise == 1;
    EXPECT_EQ(results[i].refused, gaps && cells[i].method == 3 ? "needs every sample" : "");
    if (!results[i].refused.empty()) continue;
    const bool filled = !gaps || cells[i].method == 2;  // slra
    EXPECT_EQ(results[i].figure("missing") == 0, filled) << i;
  }
}

TEST_F(RunCells, DoNotDependOnHowManyAreCleanedTogether) {
  const std::vector<CellResult> together = run();
  const std::vector<CellResult> single = run({.memory = 1});

  for (std::size_t i = 0; i < together.size(); ++i) expect_same(single[i], together[i]);
}

TEST_F(RunCells, TakeFinishedOnesFromTheResults) {
  const TemporaryFolder folder;
  CellResults kept(folder.path() / "cells.jsonl");
  Index computed = 0;
  const CellRun keeping{.program = "moclean 1",
                        .device = "x",
                        .memory = 1,
                        .results = &kept,
                        .monitor = {.report = [&](const Progress&) { ++computed; }}};
  experiment_.seeds = {1};
  const std::vector<CellResult> first = run(keeping);
  EXPECT_EQ(computed, 16);

  computed = 0;
  const std::vector<CellResult> again = run(keeping);
  EXPECT_EQ(computed, 0);
  for (std::size_t i = 0; i < first.size(); ++i) expect_same(again[i], first[i]);

  experiment_.seeds = {1, 2};
  run(keeping);
  EXPECT_EQ(computed, 16);  // those of the second seed

  computed = 0;
  experiment_.methods[1].chain = parse_chain("median:window=5");
  run(keeping);
  EXPECT_EQ(computed, 8);  // those of the changed method

  computed = 0;
  experiment_.takes[0].clip.samples(3, 3) += 1e-9;
  run(keeping);
  EXPECT_EQ(computed, 16);  // those of the changed take

  computed = 0;
  CellRun elsewhere = keeping;
  elsewhere.device = "y";
  run(elsewhere);
  EXPECT_EQ(computed, 16);  // those of matrix methods
}

TEST_F(RunCells, KeepWhatIsFinishedWhenStopped) {
  const TemporaryFolder folder;
  CellResults kept(folder.path() / "cells.jsonl");
  std::stop_source source;
  Index computed = 0;
  const auto stop_soon = [&](const Progress& progress) {
    computed = progress.finished;
    if (progress.finished >= 5) source.request_stop();
  };

  EXPECT_THROW(run({.memory = 1,
                    .results = &kept,
                    .monitor = {.report = stop_soon, .stop = source.get_token()}}),
               Cancelled);
  EXPECT_EQ(computed, 5);
  Index more = 0;
  run({.memory = 1, .results = &kept, .monitor = {.report = [&](const Progress&) { ++more; }}});
  EXPECT_EQ(more, 32 - 5);
}

TEST_F(RunCells, NameATakeWithoutTheFrameRateAMethodNeeds) {
  experiment_.takes[1].clip.frame_rate = 0;
  experiment_.methods.push_back({"b", parse_chain("butterworth:cutoff=10")});

  EXPECT_THAT([&] { run(); }, ThrowsMessage<ArgumentError>(HasSubstr(
                                  "b.npy states no frame rate, which butterworth needs")));
}

TEST(NoiseSeed, DependsOnTakeAndSeedAndFitsA32BitNumber) {
  EXPECT_EQ(noise_seed("a", 1), noise_seed("a", 1));
  EXPECT_NE(noise_seed("a", 1), noise_seed("b", 1));
  EXPECT_NE(noise_seed("a", 1), noise_seed("a", 2));
  for (std::uint64_t seed = 0; seed < 100; ++seed) EXPECT_LT(noise_seed("take", seed), 1ULL << 32);
}

}  // namespace
}  // namespace moclean::test
