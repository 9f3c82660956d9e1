#include "moclean/core/random.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

TEST(Random, FollowsTheNamedGenerator) {
  std::mt19937_64 generator(42);
  Random random(42);

  EXPECT_EQ(random.uniform(), static_cast<double>(generator() >> 11) / 9007199254740992.0);
}

TEST(Random, NormalHasTheMomentsOfAStandardNormal) {
  Random random(1);
  constexpr int count = 200000;
  double sum = 0, squares = 0, fourth = 0;
  int beyond_two = 0;

  for (int i = 0; i < count; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
    fourth += x * x * x * x;
    beyond_two += std::abs(x) > 2;
  }

  // Four standard errors of each statistic: sd 1, sqrt 2, sqrt 96, sqrt(p (1 - p)) over
  // sqrt(count).
  const double root = std::sqrt(count);
  EXPECT_NEAR(sum / count, 0, 4 / root);
  EXPECT_NEAR(squares / count, 1, 4 * std::sqrt(2.0) / root);
  EXPECT_NEAR(fourth / count, 3, 4 * std::sqrt(96.0) / root);
  EXPECT_NEAR(beyond_two / double{count}, std::erfc(std::sqrt(2.0)), 4 * 0.208 / root);
}

TEST(Random, RepeatsWithTheSeedAndDiffersWithout) {
  Random a(7), b(7), c(8);

  const double first = a.normal();

  EXPECT_EQ(first, b.normal());
  EXPECT_NE(first, c.normal());
}

// Pinned: a platform on which they differ breaks reproducibility.
TEST(Random, NormalsAreTheSameBitsEverywhere) {
  Random random(2026);

  EXPECT_EQ(random.normal(), -0x1.4fd729ebe6558p+0);
  EXPECT_EQ(random.normal(), 0x1.1c0bac8a0918cp+0);
}

TEST(Random, ChoosesDistinctSortedIndicesEquallyOften) {
  Random random(3);
  std::vector<int> hits(10);

  for (int repeat = 0; repeat < 20000; ++repeat) {
    const auto chosen = random.choose(3, 10);
    ASSERT_EQ(chosen.size(), 3u);
    EXPECT_TRUE(chosen[0] < chosen[1] && chosen[1] < chosen[2] && chosen[2] < 10);
    for (const Index i : chosen) ++hits[static_cast<std::size_t>(i)];
  }

  // Binomial(20000, 0.3): mean 6000, sd 65; five standard deviations.
  for (const int count : hits) EXPECT_NEAR(count, 6000, 325);
}

TEST(Random, RefusesToChooseMoreThanThereAre) {
  Random random(3);

  EXPECT_EQ(random.choose(5, 5), (std::vector<Index>{0, 1, 2, 3, 4}));
  EXPECT_THROW(random.choose(6, 5), ArgumentError);
}

}  // namespace
}  // namespace moclean
