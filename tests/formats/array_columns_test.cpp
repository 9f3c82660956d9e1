#include "moclean/formats/array_columns.hpp"

#include <cmath>
#include <string>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/matrix.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Shape = std::vector<std::uint64_t>;

Matrix numbers(const Shape& shape) {
  Index columns = 1;
  for (std::size_t axis = 1; axis < shape.size(); ++axis)
    columns *= static_cast<Index>(shape[axis]);
  return test::random_matrix(static_cast<Index>(shape[0]), columns, 1);
}

ArrayColumns columns(const Shape& shape, const Matrix& all, const ReadOptions& options = {}) {
  return columns_of_array(shape, all, "x.npy", options);
}

ArrayColumns columns(const Shape& shape, const ReadOptions& options = {}) {
  return columns(shape, numbers(shape), options);
}

ReadOptions told(ColumnLayout layout) {
  ReadOptions options;
  options.layout = layout;
  return options;
}

void expect_refused(const Shape& shape, const std::string& reason) {
  EXPECT_THAT([&] { columns(shape); }, testing::ThrowsMessage<FileError>(HasSubstr(reason)));
}

TEST(ArrayColumns, TakesTheLastAxisForCoordinates) {
  EXPECT_THAT(columns({9, 2, 3}).names,
              ElementsAre("joint0.x", "joint0.y", "joint0.z", "joint1.x", "joint1.y", "joint1.z"));
  EXPECT_THAT(columns({9, 2, 2}).names,
              ElementsAre("joint0.x", "joint0.y", "joint1.x", "joint1.y"));
  EXPECT_EQ(columns({9, 2, 3}).notes.layout,
            "2 points of three coordinates (an array of shape (9, 2, 3))");
  EXPECT_THAT(columns({9, 2, 3}).notes.warnings, IsEmpty());
}

TEST(ArrayColumns, SaysWhatARowOfNumbersIs) {
  EXPECT_THAT(columns({9, 3}).names, ElementsAre("joint0.x", "joint0.y", "joint0.z"));
  EXPECT_THAT(columns({9, 2}).names, ElementsAre("column0", "column1"));
  EXPECT_THAT(columns({9}).names, ElementsAre("column0"));
}

TEST(ArrayColumns, DoesWhatTheLayoutSays) {
  EXPECT_THAT(columns({9, 4}, told(ColumnLayout::points2)).names,
              ElementsAre("joint0.x", "joint0.y", "joint1.x", "joint1.y"));
  EXPECT_THAT(columns({9, 1, 3}, told(ColumnLayout::plain)).names,
              ElementsAre("column0", "column1", "column2"));
  EXPECT_THAT(
      [] {
        columns({9, 4}, told(ColumnLayout::points3));
      },
      testing::ThrowsMessage<FileError>(HasSubstr("(9, 4) of 4 columns holds no points")));
}

TEST(ArrayColumns, DoesWhatTheSpecificationSays) {
  ReadOptions options;
  options.columns = "t(xyc)*";
  const ArrayColumns found = columns({9, 7}, options);

  EXPECT_THAT(found.names, ElementsAre("point1.x", "point1.y", "point2.x", "point2.y"));
  EXPECT_THAT(found.samples, ElementsAre(1, 2, 4, 5));
  EXPECT_THAT(found.confidences, ElementsAre(3, 3, 6, 6));
  EXPECT_THAT(found.notes.passed_through, ElementsAre("column0", "column3", "column6"));
  EXPECT_THAT([&] { columns({9, 6}, options); }, testing::Throws<ArgumentError>());
}

TEST(ArrayColumns, FindsAConfidenceBehindTheCoordinates) {
  Matrix four = numbers({9, 2, 4});
  for (const Index c : {3, 7}) four.col(c) = four.col(c).cwiseAbs().cwiseMin(1);
  const ArrayColumns found = columns({9, 2, 4}, four);

  EXPECT_THAT(found.samples, ElementsAre(0, 1, 2, 4, 5, 6));
  EXPECT_THAT(found.confidences, ElementsAre(3, 3, 3, 7, 7, 7));
  EXPECT_THAT(found.notes.passed_through, ElementsAre("joint0 confidence", "joint1 confidence"));
}

TEST(ArrayColumns, FindsAConfidenceBehindTheCoordinatesOfAPicture) {
  Matrix three = 500 * numbers({9, 2, 3});
  for (const Index c : {2, 5}) three.col(c) = (three.col(c).cwiseAbs() / 1e4).cwiseMin(1);

  EXPECT_THAT(columns({9, 2, 3}, three).names,
              ElementsAre("joint0.x", "joint0.y", "joint1.x", "joint1.y"));
  three.leftCols(2) /= 100;  // metres: a z between 0 and 1 is one
  three.middleCols(3, 2) /= 100;
  EXPECT_EQ(columns({9, 2, 3}, three).names.size(), 6);
}

TEST(ArrayColumns, RefusesQuaternionsUnlessTold) {
  Matrix four = numbers({9, 2, 4});
  for (Index f = 0; f < 9; ++f)
    for (const Index c : {0, 4}) four.row(f).segment<4>(c).normalize();

  EXPECT_THAT(
      [&] {
        columns({9, 2, 4}, four);
      },
      testing::ThrowsMessage<FileError>(HasSubstr("unit quaternions, no positions")));
  EXPECT_EQ(columns({9, 2, 4}, four, told(ColumnLayout::plain)).names.size(), 8);
  for (const Index c : {0, 1, 2, 4, 5, 6}) four.col(c).setZero();
  for (const Index c : {3, 7}) four.col(c).setOnes();
  EXPECT_EQ(columns({9, 2, 4}, four).names.size(), 6) << "homogeneous coordinates";
}

TEST(ArrayColumns, RefusesBatchesAndTransposedArraysWithTheLikelyReason) {
  expect_refused({1, 120, 17, 3}, "(1, 120, 17, 3): a batch of one take? Save array[0]");
  expect_refused({5, 120, 17, 3}, "a batch of takes, or several persons?");
  expect_refused({120, 1, 17, 3}, "one person per frame? Save array[:, 0]");
  expect_refused({120, 24, 3, 3}, "rotation matrices?");
  expect_refused({3, 17, 120}, "(axes, points, frames)? Save array.transpose(2, 1, 0)");
  expect_refused({4, 17, 120}, "(axes, points, frames)?");
  expect_refused({120, 3, 17}, "(frames, axes, points)? Save array.transpose(0, 2, 1)");
  expect_refused({0, 17, 3}, "expected frames and columns, found an array of shape (0, 17, 3)");
}

TEST(ArrayColumns, WarnsWhereTheSecondAxisLooksLikeTime) {
  Matrix points_first(5, 3 * 200), frames_first(200, 3 * 5);
  for (Index p = 0; p < 5; ++p)
    for (Index f = 0; f < 200; ++f)
      for (Index a = 0; a < 3; ++a) {
        const double place = 100. * static_cast<double>((7 * p + 3 * a) % 5) +
                             std::sin(0.05 * static_cast<double>(f + a));
        points_first(p, 3 * f + a) = frames_first(f, 3 * p + a) = place;
      }

  EXPECT_THAT(columns({5, 200, 3}, points_first).notes.warnings,
              ElementsAre(HasSubstr("looks like time, not the first")));
  EXPECT_THAT(columns({200, 5, 3}, frames_first).notes.warnings, IsEmpty());
}

TEST(ArrayColumns, WarnsOfALastAxisThatIsNoCoordinates) {
  const ArrayColumns found = columns({9, 2, 6});

  EXPECT_EQ(found.names[11], "column11");
  EXPECT_THAT(found.notes.warnings, ElementsAre(HasSubstr("cleaned as plain channels")));
}

}  // namespace
}  // namespace moclean
