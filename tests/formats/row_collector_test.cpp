#include "moclean/formats/row_collector.hpp"

#include <gtest/gtest.h>

namespace moclean {
namespace {

// Collects `count` rows of a text whose rows take `bytes(i)` bytes each.
template <class Bytes>
Matrix collect(Index count, const Bytes& bytes) {
  std::size_t left = 0;
  for (Index i = 0; i < count; ++i) left += bytes(i);
  RowCollector rows(2);
  for (Index i = 0; i < count; ++i) {
    double* const row = rows.add(left);
    row[0] = static_cast<double>(i);
    row[1] = -static_cast<double>(i);
    left -= bytes(i);
  }
  EXPECT_EQ(rows.count(), count);
  return rows.take();
}

Matrix expected(Index count) {
  Matrix rows(count, 2);
  rows.col(0) = Eigen::VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
  rows.col(1) = -rows.col(0);
  return rows;
}

TEST(RowCollector, KeepsEveryRowWhateverTheEstimateWas) {
  const auto even = [](Index) { return std::size_t{10}; };
  const auto shrinking = [](Index i) { return static_cast<std::size_t>(2000 - i); };
  const auto growing = [](Index i) { return static_cast<std::size_t>(1 + i); };
  const auto none = [](Index) { return std::size_t{0}; };

  EXPECT_EQ(collect(1000, even), expected(1000));
  EXPECT_EQ(collect(1000, shrinking), expected(1000));
  EXPECT_EQ(collect(1000, growing), expected(1000));
  EXPECT_EQ(collect(1000, none), expected(1000));
}

TEST(RowCollector, WithoutRowsIsEmpty) {
  const Matrix rows = RowCollector(3).take();

  EXPECT_EQ(rows.rows(), 0);
  EXPECT_EQ(rows.cols(), 3);
}

}  // namespace
}  // namespace moclean
