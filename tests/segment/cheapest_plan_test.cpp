#include "moclean/segment/cheapest_plan.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<double> costs(const Spans& candidates, auto&& cost) {
  std::vector<double> result;
  for (const Span& span : candidates) result.push_back(cost(span));
  return result;
}

double sum(const SegmentPlan& plan, const Spans& candidates, const std::vector<double>& costs) {
  double total = 0;
  for (std::size_t s = 0; s + 1 < plan.size(); ++s) {
    const auto found = std::ranges::find(candidates, Span{plan[s], plan[s + 1]});
    total += costs.at(static_cast<std::size_t>(found - candidates.begin()));
  }
  return total;
}

TEST(CandidateSegments, AreHalfToTwiceTheEqualLength) {
  const Spans candidates = candidate_segments(320, 2);  // parts of 40 frames

  EXPECT_EQ(candidates.size(), 7u + 6 + 5 + 4 + 3 + 2 + 1);
  EXPECT_EQ(candidates.front(), (Span{0, 80}));
  EXPECT_EQ(candidates[6], (Span{0, 320}));
  EXPECT_EQ(candidates.back(), (Span{240, 320}));
}

TEST(CheapestPlan, DividesEquallyWhatCostsTheSameEverywhere) {
  for (const Index frames : {200, 1001, 1918}) {
    const Spans candidates = candidate_segments(frames, 5);
    const auto constant = costs(candidates, [](const Span&) { return 3.0; });
    const auto per_frame =
        costs(candidates, [](const Span& s) { return 0.1 * double(s.frames()); });
    const auto nothing = costs(candidates, [](const Span&) { return 0.0; });

    for (const auto& given : {constant, per_frame, nothing})
      EXPECT_EQ(cheapest_plan(frames, 5, given), equal_segments(frames, 5)) << frames;
  }
}

TEST(CheapestPlan, FindsPlantedBoundaries) {
  // A segment across frame 150 or 550 of 800 costs, as do longer ones.
  const Spans candidates = candidate_segments(800, 4);
  const auto planted = costs(candidates, [](const Span& s) {
    const auto across = [&](Index frame) { return s.first < frame && frame < s.last ? 1.0 : 0.0; };
    return across(150) + across(550) + 1e-4 * double(s.frames() * s.frames()) / 800;
  });

  EXPECT_THAT(cheapest_plan(800, 4, planted), ElementsAre(0, 150, 350, 550, 800));
}

TEST(CheapestPlan, KeepsTheLimitsOfLength) {
  const auto short_ones = [](const Span& s) { return double(s.frames() * s.frames()) / 4000; };
  const auto long_ones = [](const Span& s) {
    return 1000 - double(s.frames() * s.frames()) / 4000;
  };
  const auto early = [](const Span& s) { return s.first < 400 ? double(s.frames()) : 0.0; };
  const Spans candidates = candidate_segments(800, 4);

  EXPECT_THAT(cheapest_plan(800, 4, costs(candidates, short_ones)),
              ElementsAre(0, 200, 400, 600, 800));
  for (const SegmentPlan& plan : {cheapest_plan(800, 4, costs(candidates, long_ones)),
                                  cheapest_plan(800, 4, costs(candidates, early))}) {
    ASSERT_EQ(plan.size(), 5u);
    EXPECT_EQ(plan.back(), 800);
    for (std::size_t s = 1; s < plan.size(); ++s) {
      EXPECT_GE(plan[s] - plan[s - 1], 100);
      EXPECT_LE(plan[s] - plan[s - 1], 400);
    }
  }
}

TEST(CheapestPlan, CostsNoMoreThanAnyOther) {
  const Spans candidates = candidate_segments(160, 3);  // twelve parts
  Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const auto given = costs(candidates, [&](const Span&) { return random.uniform(); });
    const SegmentPlan grid = equal_segments(160, 12);

    double least = std::numeric_limits<double>::infinity();
    for (std::size_t a = 2; a <= 8; ++a)
      for (std::size_t b = a + 2; b <= std::min<std::size_t>(a + 8, 10); ++b)
        if (12 - b <= 8)
          least = std::min(least, sum({0, grid[a], grid[b], 160}, candidates, given));

    EXPECT_NEAR(sum(cheapest_plan(160, 3, given), candidates, given), least, 1e-4);
  }
}

TEST(CheapestPlan, DoesNotDependOnRounding) {
  const Spans candidates = candidate_segments(800, 4);
  Random random(3);
  std::vector<double> nearly, equal(candidates.size(), 1.0);
  for (std::size_t i = 0; i < candidates.size(); ++i) nearly.push_back(1 + 1e-9 * random.uniform());

  EXPECT_EQ(cheapest_plan(800, 4, nearly), cheapest_plan(800, 4, equal));
}

TEST(CheapestPlan, VariesOnlyTakesLongEnough) {
  EXPECT_TRUE(can_vary(32, 2));
  EXPECT_FALSE(can_vary(31, 2));
  EXPECT_FALSE(can_vary(1000, 1));
  EXPECT_THAT([] { candidate_segments(31, 2); },
              ThrowsMessage<ArgumentError>(HasSubstr("31 frames cannot be cut into 2 segments")));
}

TEST(CheapestPlan, RefusesCostsThatAreNone) {
  const std::size_t count = candidate_segments(32, 2).size();
  std::vector<double> negative(count, 1.0), infinite(count, 1.0);
  negative[3] = -1;
  infinite[3] = std::numeric_limits<double>::infinity();

  EXPECT_THROW(cheapest_plan(32, 2, std::vector<double>(count - 1, 1.0)), ShapeError);
  EXPECT_THROW(cheapest_plan(32, 2, negative), ArgumentError);
  EXPECT_THROW(cheapest_plan(32, 2, infinite), ArgumentError);
}

}  // namespace
}  // namespace moclean
