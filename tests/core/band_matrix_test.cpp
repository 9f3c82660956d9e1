#include "moclean/core/band_matrix.hpp"

#include <gmock/gmock.h>

#include "support/band_systems.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;

TEST(DifferencePenalty, IsThatOfAPaperCalculation) {
  const BandMatrix a = difference_penalty(4, 2, 10);  // (1, -2, 1, 0) and (0, 1, -2, 1)

  EXPECT_THAT(a.rows[0], ElementsAre(10, 0, 0, 0));
  EXPECT_THAT(a.rows[1], ElementsAre(50, -20, 0, 0));
  EXPECT_THAT(a.rows[2], ElementsAre(50, -40, 10, 0));
  EXPECT_THAT(a.rows[3], ElementsAre(10, -20, 10, 0));
}

TEST(DifferencePenalty, IsZeroForNoMoreSamplesThanTheOrder) {
  for (int order = 1; order <= BandMatrix::most_width; ++order)
    for (const auto& row : difference_penalty(static_cast<std::size_t>(order), order, 1).rows)
      EXPECT_THAT(row, ElementsAre(0, 0, 0, 0));
}

TEST(BandMatrix, SolvesAPaperCalculation) {
  // (2 -1; -1 2) x = (0, 3)
  BandMatrix a{.width = 1, .rows = {{2, 0, 0, 0}, {2, -1, 0, 0}}};
  std::vector<double> x = {0, 3};

  factor(a);
  solve(a, x);

  EXPECT_NEAR(x[0], 1, test::tolerance::by_hand(1));
  EXPECT_NEAR(x[1], 2, test::tolerance::by_hand(1));
}

TEST(BandMatrix, SolvesWithASmallBackwardErrorHoweverIllConditioned) {
  for (int width = 1; width <= BandMatrix::most_width; ++width)
    for (const Index rows : {1, 2, 3, 4, 5, 8, 400})
      for (const double gamma : {1e-6, 1.0, 1e8}) {
        const test::BandSystem system = test::band_system(rows, gamma, width);
        BandMatrix a = difference_penalty(static_cast<std::size_t>(rows), width, gamma);
        for (std::size_t i = 0; i < a.size(); ++i)
          a.rows[i][0] += system.weights(static_cast<Index>(i));
        Eigen::VectorXd x = system.b;

        factor(a);
        solve(a, {x.data(), a.size()});

        EXPECT_LE(test::backward_error(system, x), test::tolerance::band_backward_error(width))
            << width << ", " << rows << " rows, gamma " << gamma;
      }
}

TEST(BandMatrix, HasTheInverseOfAPaperCalculationInItsBand) {
  // (2 -1 0; -1 2 -1; 0 -1 2)^-1 = (3 2 1; 2 4 2; 1 2 3) / 4, of which the band leaves out the 1
  BandMatrix a{.width = 1, .rows = {{2, 0, 0, 0}, {2, -1, 0, 0}, {2, -1, 0, 0}}};
  const BandMatrix original = a;

  factor(a);
  const BandMatrix inverse = inverse_in_band(a);

  const double expected[][2] = {{0.75, 0}, {1, 0.5}, {0.75, 0.5}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_NEAR(inverse.rows[i][k], expected[i][k], test::tolerance::by_hand(1)) << i << k;
  EXPECT_NEAR(trace_of_product(inverse, original), 3, test::tolerance::by_hand(3));  // of I
}

TEST(BandMatrix, InverseTimesItselfHasTheTraceOfTheIdentity) {
  for (int width = 1; width <= BandMatrix::most_width; ++width)
    for (const std::size_t rows : {1, 2, 3, 4, 5, 60}) {
      BandMatrix a = difference_penalty(rows, width, 10);
      for (auto& row : a.rows) row[0] += 1;
      const BandMatrix original = a;

      factor(a);

      EXPECT_NEAR(trace_of_product(inverse_in_band(a), original), static_cast<double>(rows), 1e-9)
          << width << ", " << rows;
    }
}

}  // namespace
}  // namespace moclean
