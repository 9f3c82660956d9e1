#include "moclean/denoise/agreement.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;
using testing::ThrowsMessage;

Denoised result_of(const Matrix& low_rank, const Matrix& sparse) {
  Denoised result;
  result.motion = low_rank;
  result.outliers = sparse;
  result.segments = {{0, 1, {.iterations = 30, .rank = 4}}, {1, 1, {.iterations = 31, .rank = 5}}};
  return result;
}

TEST(Agreement, IsPerfectWithItself) {
  const Denoised result = result_of(Matrix{{1, 2}, {3, 4}}, Matrix{{0, 1}, {0, 0}});

  const Agreement same = agreement(result, result);

  EXPECT_EQ(same.low_rank, 0);
  EXPECT_EQ(same.sparse, 0);
  EXPECT_TRUE(within(same));
}

TEST(Agreement, IsTheRelativeFrobeniusDifferenceOfEachPart) {
  const Denoised reference = result_of(Matrix{{3, 0}, {0, 4}}, Matrix{{0, 2}, {0, 0}});  // 5 and 2
  const Denoised tested = result_of(Matrix{{3, 0}, {0, 5}}, Matrix{{0, 2}, {0.5, 0}});

  const Agreement found = agreement(tested, reference);

  EXPECT_NEAR(found.low_rank, 0.2, test::tolerance::by_hand(1));
  EXPECT_NEAR(found.sparse, 0.25, test::tolerance::by_hand(1));
}

TEST(Agreement, MeasuresAgainstTheDataWhereThePartOfTheReferenceIsZero) {
  const Denoised reference = result_of(Matrix{{3, 0}, {0, 4}}, Matrix{{0, 0}, {0, 0}});
  const Denoised tested = result_of(Matrix{{3, 0}, {0, 4}}, Matrix{{0, 1}, {0, 0}});

  EXPECT_NEAR(agreement(tested, reference).sparse, 0.2, test::tolerance::by_hand(1));
}

// A body that rests, with one gross error: what is left of its motion is rounding.
TEST(Agreement, MeasuresAgainstTheDataWhereThePartOfTheReferenceIsNextToNothing) {
  const Denoised reference = result_of(Matrix{{1e-80, 0}, {0, 0}}, Matrix{{0, 100}, {0, 0}});
  const Denoised tested = result_of(Matrix{{0, 1e-80}, {0, 0}}, Matrix{{0, 100}, {0, 0}});

  EXPECT_TRUE(within(agreement(tested, reference)));
}

TEST(Agreement, CountsZeroAgainstZeroAsPerfect) {
  const Denoised zero = result_of(Matrix::Zero(2, 2), Matrix::Zero(2, 2));

  EXPECT_TRUE(within(agreement(zero, zero)));
}

TEST(Agreement, IsInfinitelyOffWhereAllOfTheReferenceIsZero) {
  const Denoised zero = result_of(Matrix::Zero(2, 2), Matrix::Zero(2, 2));
  const Denoised tested = result_of(Matrix::Ones(2, 2), Matrix::Zero(2, 2));

  EXPECT_EQ(agreement(tested, zero).low_rank, std::numeric_limits<double>::infinity());
}

TEST(Agreement, NoticesOtherIterationsAndRanksInAnySegment) {
  const Denoised reference = result_of(Matrix::Ones(2, 2), Matrix::Ones(2, 2));
  Denoised longer = reference, richer = reference;
  longer.segments[1].outcome.iterations = 32;
  richer.segments[0].outcome.rank = 5;

  EXPECT_EQ(agreement(longer, reference).iterations_apart, 1);
  EXPECT_EQ(agreement(longer, reference).ranks_apart, 0);
  EXPECT_EQ(agreement(richer, reference).ranks_apart, 1);
  EXPECT_EQ(agreement(richer, reference).iterations_apart, 0);
}

TEST(Agreement, IsWithinBoundsUpToTheBoundsThemselves) {
  EXPECT_TRUE(within({.low_rank = 1e-8, .sparse = 1e-6}));
  EXPECT_FALSE(within({.low_rank = 1.1e-8, .sparse = 0}));
  EXPECT_FALSE(within({.low_rank = 0, .sparse = 1.1e-6}));
  EXPECT_FALSE(within({.iterations_apart = 1}));
  EXPECT_FALSE(within({.ranks_apart = 1}));
}

TEST(Agreement, MixedPrecisionHasWiderBounds) {
  const AgreementBounds& bounds = mixed_agreement_bounds;

  EXPECT_TRUE(
      within({.low_rank = 1e-5, .sparse = 1e-2, .iterations_apart = 1, .ranks_apart = 3}, bounds));
  EXPECT_FALSE(within({.low_rank = 1.1e-5}, bounds));
  EXPECT_FALSE(within({.sparse = 1.1e-2}, bounds));
  EXPECT_FALSE(within({.iterations_apart = 2}, bounds));
  EXPECT_FALSE(within({.ranks_apart = 4}, bounds));
}

TEST(Agreement, TakesWhatBothLeaveMissingForEqual) {
  Matrix left = Matrix::Ones(2, 2);
  left(1, 1) = nan;
  const Denoised reference = result_of(left, Matrix::Ones(2, 2));

  EXPECT_EQ(agreement(reference, reference).low_rank, 0);
  EXPECT_TRUE(
      std::isnan(agreement(result_of(Matrix::Ones(2, 2), Matrix::Ones(2, 2)), reference).low_rank));
}

TEST(Agreement, IsNeverWithinBoundsWithNaN) {
  const Denoised reference = result_of(Matrix::Ones(2, 2), Matrix::Ones(2, 2));

  EXPECT_FALSE(
      within(agreement(result_of(Matrix::Constant(2, 2, nan), Matrix::Ones(2, 2)), reference)));
}

TEST(Agreement, RefusesOtherShapesAndSegments) {
  const Denoised reference = result_of(Matrix::Ones(2, 2), Matrix::Ones(2, 2));
  Denoised whole = reference;
  whole.segments.pop_back();

  EXPECT_THAT([&] { agreement(result_of(Matrix::Ones(3, 2), Matrix::Ones(3, 2)), reference); },
              ThrowsMessage<ShapeError>("cannot compare results of 3 frames x 2 columns and 2 "
                                        "frames x 2 columns"));
  EXPECT_THAT([&] { agreement(whole, reference); },
              ThrowsMessage<ShapeError>("cannot compare results of 1 and 2 segments"));
}

}  // namespace
}  // namespace moclean
