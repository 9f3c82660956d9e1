// Fills learned from trials.
#include "moclean/body/gap_trials.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace moclean {
namespace {

constexpr Index frames = 400;

BodyTake wave() {
  Matrix p(frames, 3);
  for (Index i = 0; i < frames; ++i) {
    const double t = static_cast<double>(i) / 15;
    p.row(i) << std::sin(t), std::cos(2 * t), std::sin(3 * t);
  }
  return body_take(p, 100);
}

// The truth, and another that is off by a constant, and another that is nowhere near.
Predictor of_three(const BodyTake& take) {
  return [&take](const Gap&, const Frames& some) {
    Candidates found;
    Matrix truth(static_cast<Index>(some.size()), 3);
    for (Index i = 0; i < truth.rows(); ++i)
      truth.row(i) = take.position(some[static_cast<std::size_t>(i)], 0);
    Matrix wild = truth;
    for (Index i = 0; i < wild.rows(); ++i)
      wild.row(i).array() += std::sin(static_cast<double>(7 * some[static_cast<std::size_t>(i)]));
    found.positions = {truth.array() + 5, wild};
    return found;
  };
}

std::vector<Gap> twelve() {
  return trials({0, 100, 140}, 40, 5, 12, std::vector<bool>(frames, true));
}

TEST(Trials, LieWhereEdgesAndProbesAreUsable) {
  std::vector<bool> usable(100, true);
  for (std::size_t i = 40; i < 100; ++i) usable[i] = false;

  const std::vector<Gap> found = trials({0, 60, 70}, 10, 5, 3, usable);

  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].first, 1);
  EXPECT_EQ(found[1].first, 15);
  EXPECT_EQ(found[2].last, 39);  // its edge is the last that is usable
}

TEST(LearnFillRule, TakesOutWhatMissesTheEdges) {
  const BodyTake take = wave();

  const FillRule rule = learn_fill_rule(take, twelve(), 5, of_three(take));
  const Matrix found = fill(take, {0, 100, 140}, of_three(take), rule);

  EXPECT_GT(rule.shares[0].weight, 0.999);
  EXPECT_LE((found.leftCols(3) - take.positions.middleRows(100, 40)).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_NEAR(rule.usual_miss, 25, 1e-3);
}

// Errors of one deviation everywhere, independent: their variance is what comes out.
TEST(LearnFillRule, KnowsTheVarianceOfItsTrials) {
  const BodyTake take = wave();
  const auto noisy = [&take](const Gap& gap, const Frames& some) {
    Matrix positions(static_cast<Index>(some.size()), 3);
    for (Index i = 0; i < positions.rows(); ++i) {
      const Index frame = some[static_cast<std::size_t>(i)];
      const bool inner = frame >= gap.first && frame < gap.last;
      const double error = inner ? 0.3 * std::sin(static_cast<double>(17 * frame)) : 0;
      positions.row(i) = take.position(frame, 0).array() + error;
    }
    return Candidates{{positions}, {}};
  };

  const FillRule rule = learn_fill_rule(take, twelve(), 5, noisy);
  const Matrix found = fill(take, {0, 100, 140}, noisy, rule);

  EXPECT_NEAR(found(20, 3), 0.3 * 0.3 / 2, 0.03);
  EXPECT_LT(found(0, 3), found(20, 3) / 2);  // near an edge it is surer
}

TEST(LearnFillRule, IsEmptyWithoutTrials) {
  const BodyTake take = wave();

  EXPECT_TRUE(learn_fill_rule(take, {}, 5, of_three(take)).empty());
}

}  // namespace
}  // namespace moclean
