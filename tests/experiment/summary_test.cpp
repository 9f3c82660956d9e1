#include "moclean/experiment/summary.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "experiment/small_experiment.hpp"

namespace moclean::test {
namespace {

const double no_number = std::nan("");

TEST(SpreadOfValues, IsThatOfASample) {
  const std::vector<double> values = {1, no_number, 2, 6};
  const std::vector<double> one = {4};

  EXPECT_EQ(spread(values), (Spread{.mean = 3, .sd = std::sqrt(7.0), .count = 3}));
  EXPECT_EQ(spread(one), (Spread{.mean = 4, .sd = 0, .count = 1}));
  EXPECT_TRUE(std::isnan(spread({}).mean));
  EXPECT_TRUE(std::isnan(spread({}).sd));
}

// One take, two noises, three methods, two seeds; FD as given, [noise][method][seed].
class Ranking : public ::testing::Test {
 protected:
  Ranking() {
    experiment_.takes = {small_take("a \"1\", b", 4)};
    experiment_.noises.resize(2);
    experiment_.methods.resize(3);
    experiment_.noises[0].label = "p";
    experiment_.noises[1].label = "q";
    experiment_.methods[0].label = "one";
    experiment_.methods[1].label = "two";
    experiment_.methods[2].label = "three";
    cells_ = all_cells(experiment_);
    const double fd[] = {3, 5, 1, 2, 3, 5, 1, 1, 2, 2, 3, 3};
    for (const double value : fd)
      results_.push_back(
          {.figures = {{"fd", value}, {"missing", 0.0}, {"seconds", 0.5}}, .frames = 4});
  }

  const Standing& of(const std::vector<Standing>& standings, std::size_t method) const {
    return *std::ranges::find(standings, method, &Standing::method);
  }

  Experiment experiment_{.takes = {}, .noises = {}, .methods = {}, .seeds = {1, 2}};
  std::vector<Cell> cells_;
  std::vector<CellResult> results_;
};

TEST_F(Ranking, IsByTheMeanPlace) {
  const auto standings = ranking(experiment_, cells_, results_);

  ASSERT_EQ(standings.size(), 3U);
  EXPECT_EQ(standings[0].method, 1U);
  EXPECT_EQ(standings[0].mean_rank, 1.5);                // 1 and 2
  EXPECT_EQ(of(standings, 0).mean_rank, (2.5 + 1) / 2);  // shares 2 and 3 with the third
  EXPECT_EQ(of(standings, 2).mean_rank, (2.5 + 3) / 2);
  EXPECT_EQ(of(standings, 0).wins, 1);
  EXPECT_EQ(of(standings, 0).fd[0], (Spread{.mean = 4, .sd = std::sqrt(2.0), .count = 2}));
  EXPECT_EQ(of(standings, 0).frames_per_second, 8);
}

TEST_F(Ranking, PutsWhatIsIncompleteLast) {
  results_[6].figures["missing"] = 0.1;                  // method one, noise q
  results_[2] = {.refused = "needs more", .frames = 4};  // method two, noise p

  const auto standings = ranking(experiment_, cells_, results_);

  EXPECT_EQ(of(standings, 0).mean_rank, (1.5 + 3) / 2);
  EXPECT_EQ(of(standings, 1).mean_rank, (3 + 1) / 2.0);
  EXPECT_EQ(of(standings, 1).incomplete, 1);
  EXPECT_EQ(of(standings, 1).fd[0].mean, 2);  // of the other seed
}

TEST_F(Ranking, CellsBecomeATable) {
  results_[1].figures["fd"] = 0.1;
  results_[2] = {.refused = "needs, more", .frames = 4};

  const std::string text = cells_csv(experiment_, cells_, results_);

  const std::string own = std::to_string(noise_seed("a \"1\", b", 1));
  EXPECT_THAT(text, testing::StartsWith(
                        "take,noise,method,seed,noise_seed,frames,fd,missing,seconds,refused\n"
                        "\"a \"\"1\"\", b\",p,one,1," +
                        own + ",4,3,0,0.5,\n"));
  EXPECT_THAT(text, testing::HasSubstr(",4,0.1,0,0.5,\n"));
  EXPECT_THAT(text, testing::HasSubstr(",p,two,1," + own + ",4,,,,\"needs, more\"\n"));
}

TEST_F(Ranking, FiguresThatCameLaterStandAtTheEnd) {
  results_[1].figures["strikes"] = 0.75;
  results_[1].figures["worst"] = 2;
  results_[1].figures["smoothness"] = 3;

  const std::string text = cells_csv(experiment_, cells_, results_);

  EXPECT_THAT(text, testing::StartsWith("take,noise,method,seed,noise_seed,frames,fd,missing,"
                                        "seconds,smoothness,refused,strikes,worst\n"));
  EXPECT_THAT(text, testing::HasSubstr(",0.5,3,,0.75,2\n"));
  EXPECT_THAT(text, testing::HasSubstr(",0.5,,,,\n"));
}

}  // namespace
}  // namespace moclean::test
