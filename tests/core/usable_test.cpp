#include "moclean/core/usable.hpp"

#include <limits>

#include <gmock/gmock.h>

namespace moclean {
namespace {

using testing::FieldsAre;
using testing::Optional;

constexpr double infinite = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();

TEST(FirstUnusable, IsNothingWhereAllAreNumbers) {
  EXPECT_FALSE(first_unusable(Matrix{{1, -2}, {0, 5}}, false, 5));
  EXPECT_FALSE(first_unusable(Matrix(0, 3), false, 5));
}

TEST(FirstUnusable, IsTheFirstFrameByFrame) {
  EXPECT_THAT(first_unusable(Matrix{{1, 2}, {3, infinite}, {nan, 6}}, false, 9),
              Optional(FieldsAre(1, 1)));
  EXPECT_THAT(first_unusable(Matrix{{1, 2}, {-3, 7}}, false, 2), Optional(FieldsAre(1, 0)));
}

TEST(FirstUnusable, LetsNanPassWhereMissingOnesAreAccepted) {
  const Matrix samples{{1, nan}, {nan, -infinite}};

  EXPECT_THAT(first_unusable(samples, false, 9), Optional(FieldsAre(0, 1)));
  EXPECT_THAT(first_unusable(samples, true, 9), Optional(FieldsAre(1, 1)));
  EXPECT_FALSE(first_unusable(samples.topRows(1), true, 9));
}

}  // namespace
}  // namespace moclean
