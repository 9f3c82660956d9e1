#include "moclean/formats/missing_marks.hpp"

#include <gmock/gmock.h>

#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::nan;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Recording point_and_channel(const Matrix& samples) {
  return {samples, {"N.x", "N.y", "N.z", "angle"}, 0, ""};
}

TEST(MissingMarks, AreAppliedToWholePointsAndToChannels) {
  Recording take = point_and_channel(Matrix{{1, 2, 3, -9}, {-9, 5, 6, 7}, {-8, -9.5, 6, 7}});

  apply_missing_marks({-9}, take);

  EXPECT_TRUE(
      test::same_bits(take.samples, Matrix{{1, 2, 3, nan}, {nan, nan, nan, 7}, {-8, -9.5, 6, 7}}));
}

TEST(MissingMarks, ZeroMeansAPointOfWhichAllCoordinatesAreZero) {
  Recording take = point_and_channel(Matrix{{0, 0, 0, 0}, {0, 2, 0, 1}});

  apply_missing_marks({0}, take);

  EXPECT_TRUE(test::same_bits(take.samples, Matrix{{nan, nan, nan, nan}, {0, 2, 0, 1}}));
}

// Ten frames around 100, in some of which everything says `number`.
Recording with(double number, Index first, Index count) {
  Matrix samples = 100 + test::random_matrix(10, 4, 1).array();
  samples.middleRows(first, count).setConstant(number);
  return point_and_channel(samples);
}

std::vector<std::string> warnings(Recording take) {
  warn_of_marks(take);
  return take.notes.warnings;
}

TEST(MissingMarks, NumbersThatRecurLikeOneAreNamed) {
  EXPECT_THAT(warnings(with(-9999, 4, 3)),
              ElementsAre("-9999 stands in 6 samples, first of N, as if it meant a missing one; if "
                          "so, give --missing -9999"));
  EXPECT_THAT(warnings(with(12345, 4, 3)), ElementsAre(HasSubstr("12345 stands in 3 samples")))
      << "of the point only: a channel may well repeat";
}

TEST(MissingMarks, OtherNumbersAreNot) {
  EXPECT_THAT(warnings(with(-9999, 4, 2)), IsEmpty()) << "too few";
  EXPECT_THAT(warnings(with(-9999, 0, 10)), IsEmpty()) << "constant";
  EXPECT_THAT(warnings(with(0, 4, 3)), IsEmpty()) << "the methods look at zeros themselves";
  EXPECT_THAT(warnings(with(101, 4, 3)), IsEmpty()) << "within the range of all else";
}

}  // namespace
}  // namespace moclean
