#include "moclean/metric/touched.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;
using testing::ThrowsMessage;

TEST(RmseWhere, SeparatesTouchedFromUntouchedEntries) {
  const Matrix truth{{0, 0}, {0, 0}};
  const Matrix estimate{{3, 1}, {4, 2}};
  const Mask mask{{true, false}, {true, false}};

  EXPECT_NEAR(rmse_where(truth, estimate, mask, true), std::sqrt(25 / 2.0),
              test::tolerance::by_hand(5));
  EXPECT_NEAR(rmse_where(truth, estimate, mask, false), std::sqrt(5 / 2.0),
              test::tolerance::by_hand(2));
}

TEST(RmseWhere, LeavesNaNOutAndIsNaNWhereNothingIsLeft) {
  const Matrix truth{{0, 0}};

  EXPECT_EQ(rmse_where(truth, Matrix{{nan, 2}}, Mask{{true, true}}, true), 2);
  EXPECT_TRUE(std::isnan(rmse_where(truth, Matrix{{1, 2}}, Mask{{true, true}}, false)));
}

TEST(RmseWhere, RefusesAMaskOfAnotherShape) {
  EXPECT_THAT(
      [] {
        rmse_where(Matrix{{0, 0}}, Matrix{{1, 2}}, Mask{{true}}, true);
      },
      ThrowsMessage<ShapeError>(
          "the mask of 1 frames x 1 columns does not fit a clip of 1 frames x 2 columns"));
}

TEST(DetectionOfOutliers, CountsHitsFalseAlarmsAndMisses) {
  const Mask touched{{true, true, true, false, false, false}};
  const Matrix outliers{{1, -2, 0, 3, 0, 0}};

  const Detection result = detection(touched, outliers);

  EXPECT_EQ(result.hits, 2);
  EXPECT_EQ(result.false_alarms, 1);
  EXPECT_EQ(result.misses, 1);
  EXPECT_NEAR(result.precision(), 2 / 3.0, test::tolerance::by_hand(1));
  EXPECT_NEAR(result.recall(), 2 / 3.0, test::tolerance::by_hand(1));
  EXPECT_NEAR(result.f1(), 4 / 6.0, test::tolerance::by_hand(1));
}

TEST(DetectionOfOutliers, HeedsTheThresholdAndLeavesNaNOut) {
  const Mask touched{{true, true, false, true}};
  const Matrix outliers{{1, -2, 0.5, nan}};

  const Detection result = detection(touched, outliers, 1);

  EXPECT_EQ(result.hits, 1);
  EXPECT_EQ(result.false_alarms, 0);
  EXPECT_EQ(result.misses, 1);
}

TEST(DetectionOfOutliers, HasNoRatioOfNothing) {
  const Detection none = detection(Mask{{false}}, Matrix{{0}});

  EXPECT_TRUE(std::isnan(none.precision()));
  EXPECT_TRUE(std::isnan(none.recall()));
  EXPECT_TRUE(std::isnan(none.f1()));
  EXPECT_EQ(detection(Mask{{true}}, Matrix{{0}}).recall(), 0);
  EXPECT_EQ(detection(Mask{{true}}, Matrix{{0}}).f1(), 0);
}

}  // namespace
}  // namespace moclean
