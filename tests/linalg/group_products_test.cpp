#include "moclean/linalg/group_products.hpp"

#include <tuple>

#include <gtest/gtest.h>

#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/squares.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::Shape;

using test::nan;

class GroupProductsTest : public testing::TestWithParam<std::tuple<int, Shape>> {
 protected:
  // Three segments: one and a half times, once, and a third of the rows, at least one each.
  GroupProductsTest()
      : data_(test::batch_of({random(shape().rows * 3 / 2 + 1, 1), random(shape().rows, 2),
                              random(shape().rows / 3 + 1, 3)})),
        batch_(test::device(), data_, 0, 3),
        x_(test::device(), std::as_const(data_).storage()),
        products_(test::device(), std::get<0>(GetParam())) {}

  static Shape shape() { return std::get<1>(GetParam()); }
  static Matrix random(Index rows, std::uint64_t seed) {
    return test::random_matrix(rows, shape().columns, seed);
  }

  // Results start as NaN, so that what is not written shows.
  static Buffer<double> unwritten(std::size_t size) {
    return Buffer<double>(test::device(), std::span<const double>(std::vector<double>(size, nan)));
  }

  std::vector<Matrix> squares_of(const Buffer<double>& buffer) const {
    return test::download_squares(batch_, buffer);
  }

  Buffer<double> upload(const std::vector<Matrix>& matrices) const {
    return test::upload_squares(batch_, matrices);
  }

  std::vector<Matrix> random_squares(std::uint64_t seed) const {
    std::vector<Matrix> matrices;
    for (Index b = 0; b < 3; ++b)
      matrices.push_back(
          test::random_matrix(order(b), order(b), seed + static_cast<std::uint64_t>(b)));
    return matrices;
  }

  void expect_padding_is_zero(const SegmentBatch& result) const {
    const Eigen::Map<const Matrix> rows(result.storage().data(), result.rows(), result.pitch());
    EXPECT_EQ(rows.rightCols(result.pitch() - result.columns()).cwiseAbs().sum(), 0);
  }

  Index order(Index b) const { return batch_.segment(b).order; }
  bool wide(Index b) const { return batch_.segment(b).wide(); }
  static double tolerance(Index size) { return test::tolerance::decomposition(size); }

  SegmentBatch data_;
  Batch batch_;
  Buffer<double> x_;
  GroupProducts<double> products_;
};

TEST_P(GroupProductsTest, GramMatchesReferenceInTheUpperTriangle) {
  Buffer<double> g = unwritten(batch_.square_size());

  products_.gram(batch_, x_, g);

  const std::vector<Matrix> results = squares_of(g);
  for (Index b = 0; b < 3; ++b) {
    const Matrix x = data_.segment(b);
    const Matrix expected = wide(b) ? Matrix(x * x.transpose()) : Matrix(x.transpose() * x);
    const Matrix upper =
        results[static_cast<std::size_t>(b)].leftCols(order(b)).triangularView<Eigen::Upper>();
    EXPECT_LE((upper - Matrix(expected.triangularView<Eigen::Upper>())).norm(),
              tolerance(std::max(x.rows(), x.cols())) * expected.norm());
  }
}

// Rows of Z past the wanted terms hold NaN: they must not be read.
TEST_P(GroupProductsTest, ReconstructMatchesReferenceAndReadsNoMoreThanItsTerms) {
  std::vector<Matrix> z = random_squares(10);
  std::vector<double> f(batch_.vector_size());
  std::vector<std::int32_t> terms;
  for (Index b = 0; b < 3; ++b) {
    terms.push_back(static_cast<std::int32_t>((2 * order(b) + 2) / 3));
    z[static_cast<std::size_t>(b)].bottomRows(order(b) - terms.back()).setConstant(nan);
    for (Index k = 0; k < terms.back(); ++k)
      f[static_cast<std::size_t>(batch_.segment(b).vector + k)] = 1 / static_cast<double>(k + 1);
  }
  const Buffer<double> weights(test::device(), std::span<const double>(f));
  const Buffer<std::int32_t> wanted(test::device(), std::span<const std::int32_t>(terms));
  Buffer<double> w = unwritten(batch_.square_size());

  products_.reconstruct(batch_, upload(z), weights, wanted, w);

  const std::vector<Matrix> results = squares_of(w);
  for (Index b = 0; b < 3; ++b) {
    const auto i = static_cast<std::size_t>(b);
    const Matrix zb = z[i].topRows(terms[i]);
    const Eigen::Map<const Eigen::VectorXd> fb(f.data() + batch_.segment(b).vector, terms[i]);
    const Matrix expected = zb.transpose() * fb.asDiagonal() * zb;
    EXPECT_LE((results[i].leftCols(order(b)) - expected).norm(),
              tolerance(order(b)) * expected.norm());
    EXPECT_EQ(results[i].rightCols(results[i].cols() - order(b)).cwiseAbs().sum(), 0);
  }
}

TEST_P(GroupProductsTest, ApplyMatchesReferenceAndKeepsThePaddingZero) {
  const std::vector<Matrix> w = random_squares(20);
  Buffer<double> a = unwritten(batch_.stacked_size());
  SegmentBatch result(data_.columns(), data_.first_rows());

  products_.apply(batch_, x_, upload(w), a);
  a.read(result.storage());

  for (Index b = 0; b < 3; ++b) {
    const Matrix x = data_.segment(b);
    const Matrix& wb = w[static_cast<std::size_t>(b)];
    const Matrix expected = wide(b) ? Matrix(wb * x) : Matrix(x * wb);
    EXPECT_LE((Matrix(result.segment(b)) - expected).norm(), tolerance(order(b)) * expected.norm());
  }
  expect_padding_is_zero(result);
}

TEST_P(GroupProductsTest, RotateMatchesReferenceAndKeepsThePaddingZero) {
  const std::vector<Matrix> z = random_squares(30);
  Buffer<double> rotated = unwritten(batch_.stacked_size());
  SegmentBatch result(data_.columns(), data_.first_rows());

  products_.rotate(batch_, x_, upload(z), rotated);
  rotated.read(result.storage());

  for (Index b = 0; b < 3; ++b) {
    const Matrix x = data_.segment(b);
    const Matrix& zb = z[static_cast<std::size_t>(b)];
    const Matrix expected = wide(b) ? Matrix(zb * x) : Matrix(x * zb.transpose());
    EXPECT_LE((Matrix(result.segment(b)) - expected).norm(), tolerance(order(b)) * expected.norm());
  }
  expect_padding_is_zero(result);
}

TEST_P(GroupProductsTest, ComposeMatchesReference) {
  const std::vector<Matrix> p = random_squares(40), z = random_squares(50);
  Buffer<double> c = unwritten(batch_.square_size());

  products_.compose(batch_, upload(p), upload(z), c);

  const std::vector<Matrix> results = squares_of(c);
  for (Index b = 0; b < 3; ++b) {
    const auto i = static_cast<std::size_t>(b);
    const Matrix expected = p[i] * z[i];
    EXPECT_LE((results[i].leftCols(order(b)) - expected).norm(),
              tolerance(order(b)) * expected.norm());
  }
}

TEST_P(GroupProductsTest, GramOfASegmentDependsNeitherOnItsNeighboursNorOnTheWorkGroup) {
  Buffer<double> together = unwritten(batch_.square_size());
  products_.gram(batch_, x_, together);
  const SegmentBatch alone = test::batch_of({Matrix(data_.segment(1))});
  const Batch single(test::device(), alone, 0, 1);
  Buffer<double> g = unwritten(single.square_size());

  GroupProducts<double>(test::device(), 32)
      .gram(single, Buffer<double>(test::device(), std::as_const(alone).storage()), g);

  std::vector<double> values(single.square_size());
  g.read(values);
  const Matrix expected =
      Eigen::Map<const Matrix>(values.data(), order(1), batch_.segment(1).order_pitch)
          .triangularView<Eigen::Upper>();
  const Matrix result = squares_of(together)[1].triangularView<Eigen::Upper>();
  EXPECT_TRUE(test::same_bits(result, expected));
}

std::string name_of_group_products(const testing::TestParamInfo<std::tuple<int, Shape>>& info) {
  const auto& [work_group, shape] = info.param;
  return "WG" + std::to_string(work_group) + "_" + std::to_string(shape.rows) + "x" +
         std::to_string(shape.columns);
}

INSTANTIATE_TEST_SUITE_P(Shapes, GroupProductsTest,
                         testing::Combine(testing::Values(16, 64, 128, 256),
                                          testing::Values(Shape{1, 1}, Shape{3, 5}, Shape{64, 64},
                                                          Shape{200, 93}, Shape{61, 129},
                                                          Shape{25, 93}, Shape{17, 1})),
                         name_of_group_products);

TEST(GroupProducts, RefusesAWorkGroupItHasNoTileFor) {
  EXPECT_THROW(GroupProducts<double>(test::device(), 8), ArgumentError);
  EXPECT_THROW(GroupProducts<double>(test::device(), 512), ArgumentError);
}

}  // namespace
}  // namespace moclean
