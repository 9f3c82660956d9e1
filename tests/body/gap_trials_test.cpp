// Fills learned from trials.
#include "moclean/body/gap_trials.hpp"

#include <array>
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
    Matrix truth(static_cast<Index>(some.size()), 3);
    for (Index i = 0; i < truth.rows(); ++i)
      truth.row(i) = take.position(some[static_cast<std::size_t>(i)], 0);
    Matrix wild = truth;
    for (Index i = 0; i < wild.rows(); ++i)
      wild.row(i).array() += std::sin(static_cast<double>(7 * some[static_cast<std::size_t>(i)]));
    return Candidates{truth.array() + 5, wild};
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
}

// Errors of one deviation everywhere, independent, of the only candidate: their variance is what
// comes out.
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
    return Candidates{positions};
  };

  const FillRule rule = learn_fill_rule(take, twelve(), 5, noisy);
  const Matrix found = fill(take, {0, 100, 140}, noisy, rule);

  EXPECT_NEAR(found(20, 3), 0.3 * 0.3 / 2, 0.03);
  EXPECT_LT(found(0, 3), found(20, 3) / 2);  // near an edge it is surer
}

// Two candidates of independent errors, a hundred times as large in the second half of the take.
TEST(LearnFillRule, IsAsSureAsItsCandidatesAgree) {
  const BodyTake take = wave();
  const auto two = [&take](const Gap& gap, const Frames& some) {
    Candidates found(2, Matrix(static_cast<Index>(some.size()), 3));
    for (Index i = 0; i < found[0].rows(); ++i) {
      const Index frame = some[static_cast<std::size_t>(i)];
      const bool inner = frame >= gap.first && frame < gap.last;
      const double scale = !inner ? 0 : frame < frames / 2 ? 0.003 : 0.3;
      for (Index k = 0; k < 2; ++k)
        for (Index c = 0; c < 3; ++c)
          found[static_cast<std::size_t>(k)](i, c) =
              take.position(frame, 0)(c) +
              scale * std::sin(static_cast<double>((17 + 12 * k + 5 * c) * frame));
    }
    return found;
  };

  const FillRule rule = learn_fill_rule(take, twelve(), 5, two);

  std::array<double, 2> stated = {};
  for (const std::size_t half : {0U, 1U}) {
    const Gap gap{0, half == 0 ? 40 : 300, half == 0 ? 100 : 360};
    const Matrix found = fill(take, gap, two, rule);
    const Matrix off = found.leftCols(3) - take.positions.middleRows(gap.first, 60);
    stated[half] = found.col(3).mean();
    EXPECT_GT(stated[half], off.squaredNorm() / 180);
  }
  EXPECT_LT(stated[1], 0.3 * 0.3 * 2);
  EXPECT_LT(stated[0], stated[1] / 300);
}

// A joint that was exchanged in the frame beside its gap: no trial missed its edges so.
TEST(LearnFillRule, DoubtsAnEdgeThatIsMissed) {
  BodyTake take = wave();
  const Predictor predict = of_three(take);
  const BodyTake truth = take;
  const Predictor from_truth = of_three(truth);
  const FillRule rule = learn_fill_rule(take, twelve(), 5, predict);
  const double sure = fill(take, {0, 100, 140}, from_truth, rule)(20, 3);

  take.positions(99, 0) -= 4;
  const double doubtful = fill(take, {0, 100, 140}, from_truth, rule)(20, 3);

  // (9^2 + 5^2 + 5^2) + 3 5^2 over six coordinates, less 5^2 of any trial
  EXPECT_NEAR(doubtful - sure, (81 + 5 * 25) / 6. - 25, 0.5);
}

TEST(LearnFillRule, IsEmptyWithoutTrials) {
  const BodyTake take = wave();

  EXPECT_TRUE(learn_fill_rule(take, {}, 5, of_three(take)).empty());
}

}  // namespace
}  // namespace moclean
