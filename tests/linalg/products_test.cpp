#include "moclean/linalg/products.hpp"

#include <tuple>

#include <gtest/gtest.h>

#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/squares.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

struct Way {
  const char* name;
  KernelForm form = KernelForm::cpu;
  ProductPath products = ProductPath::own;
};

using test::Shape;

class ProductsTest : public testing::TestWithParam<std::tuple<Way, Shape>> {
 protected:
  // Three segments: one and a half times, once, and a third of the rows, at least one each.
  ProductsTest()
      : data_(test::batch_of({random(shape().rows * 3 / 2 + 1, 1), random(shape().rows, 2),
                              random(shape().rows / 3 + 1, 3)})),
        batch_(test::device(), data_, 0, 3),
        x_(test::device(), data_.storage()),
        products_(test::device(), {.form = way().form, .products = way().products}) {}

  static Way way() { return std::get<0>(GetParam()); }
  static Shape shape() { return std::get<1>(GetParam()); }
  static Matrix random(Index rows, std::uint64_t seed) {
    return test::random_matrix(rows, shape().columns, seed);
  }

  Buffer<double> zeros(std::size_t size) const {
    Buffer<double> buffer(test::device(), size);
    buffer.fill_zero();
    return buffer;
  }

  // The order x order matrix of a segment among all of them, read back.
  Matrix square(const Buffer<double>& buffer, Index b) const {
    return test::download_squares(batch_, buffer)[static_cast<std::size_t>(b)].leftCols(order(b));
  }

  Buffer<double> squares(const std::vector<Matrix>& matrices) const {
    return test::upload_squares(batch_, matrices);
  }

  Index order(Index b) const { return batch_.segment(b).order; }

  SegmentBatch data_;
  Batch batch_;
  Buffer<double> x_;
  Products<double> products_;
};

TEST_P(ProductsTest, GramMatchesReferenceInTheUpperTriangle) {
  Buffer<double> g = zeros(batch_.square_size());

  products_.gram(batch_, x_, g);

  for (Index b = 0; b < 3; ++b) {
    const Matrix x = data_.segment(b);
    const Matrix expected =
        batch_.segment(b).wide() ? Matrix(x * x.transpose()) : Matrix(x.transpose() * x);
    const Matrix upper = square(g, b).triangularView<Eigen::Upper>();
    EXPECT_LE((upper - Matrix(expected.triangularView<Eigen::Upper>())).norm(),
              test::tolerance::decomposition(x.rows()) * expected.norm());
  }
}

TEST_P(ProductsTest, ReconstructMatchesReference) {
  std::vector<Matrix> z;
  std::vector<double> f(batch_.vector_size());
  std::vector<std::int32_t> terms;
  for (Index b = 0; b < 3; ++b) {
    z.push_back(test::random_matrix(order(b), order(b), static_cast<std::uint64_t>(10 + b)));
    terms.push_back(static_cast<std::int32_t>(order(b) / 2 + 1));  // as many lie above a threshold
    for (Index k = 0; k < terms.back(); ++k)
      f[static_cast<std::size_t>(batch_.segment(b).vector + k)] = 1 / static_cast<double>(k + 1);
  }
  const Buffer<double> weights(test::device(), std::span<const double>(f));
  Buffer<double> w = zeros(batch_.square_size());

  products_.reconstruct(batch_, squares(z), weights,
                        Buffer<std::int32_t>(test::device(), std::span<const std::int32_t>(terms)),
                        w);

  for (Index b = 0; b < 3; ++b) {
    const Matrix& zb = z[static_cast<std::size_t>(b)];
    const Eigen::Map<const Eigen::VectorXd> fb(f.data() + batch_.segment(b).vector, order(b));
    const Matrix expected = zb.transpose() * fb.asDiagonal() * zb;
    EXPECT_LE((square(w, b) - expected).norm(),
              test::tolerance::decomposition(order(b)) * expected.norm());
  }
}

TEST_P(ProductsTest, ApplyMatchesReferenceAndKeepsThePaddingZero) {
  std::vector<Matrix> w;
  for (Index b = 0; b < 3; ++b)
    w.push_back(test::random_matrix(order(b), order(b), static_cast<std::uint64_t>(20 + b)));
  Buffer<double> a = zeros(batch_.stacked_size());
  SegmentBatch result(data_.columns(), data_.first_rows());

  products_.apply(batch_, x_, squares(w), a);
  a.read(result.storage());

  for (Index b = 0; b < 3; ++b) {
    const Matrix x = data_.segment(b);
    const Matrix& wb = w[static_cast<std::size_t>(b)];
    const Matrix expected = batch_.segment(b).wide() ? Matrix(wb * x) : Matrix(x * wb);
    EXPECT_LE((Matrix(result.segment(b)) - expected).norm(),
              test::tolerance::decomposition(order(b)) * expected.norm());
  }
  const Eigen::Map<const Matrix> padded_rows(result.storage().data(), result.rows(),
                                             result.pitch());
  EXPECT_EQ(padded_rows.rightCols(result.pitch() - result.columns()).cwiseAbs().sum(), 0);
}

TEST_P(ProductsTest, RotateAndComposeMatchReference) {
  std::vector<Matrix> z, p;
  for (Index b = 0; b < 3; ++b) {
    z.push_back(test::random_matrix(order(b), order(b), static_cast<std::uint64_t>(30 + b)));
    p.push_back(test::random_matrix(order(b), order(b), static_cast<std::uint64_t>(40 + b)));
  }
  Buffer<double> rotated = zeros(batch_.stacked_size()), composed = zeros(batch_.square_size());
  SegmentBatch result(data_.columns(), data_.first_rows());

  products_.rotate(batch_, x_, squares(z), rotated);
  products_.compose(batch_, squares(p), squares(z), composed);
  rotated.read(result.storage());

  for (Index b = 0; b < 3; ++b) {
    const auto i = static_cast<std::size_t>(b);
    const Matrix x = data_.segment(b);
    const Matrix expected =
        batch_.segment(b).wide() ? Matrix(z[i] * x) : Matrix(x * z[i].transpose());
    const Matrix product = p[i] * z[i];
    const double tolerance = test::tolerance::decomposition(order(b));
    EXPECT_LE((Matrix(result.segment(b)) - expected).norm(), tolerance * expected.norm());
    EXPECT_LE((square(composed, b) - product).norm(), tolerance * product.norm());
  }
}

TEST_P(ProductsTest, OfASegmentDoNotDependOnItsNeighbours) {
  Buffer<double> together = zeros(batch_.square_size());
  products_.gram(batch_, x_, together);
  const SegmentBatch alone = test::batch_of({Matrix(data_.segment(1))});
  const Batch single(test::device(), alone, 0, 1);
  Buffer<double> g = zeros(single.square_size());

  products_.gram(single, Buffer<double>(test::device(), std::as_const(alone).storage()), g);

  std::vector<double> values(single.square_size());
  g.read(values);
  const Matrix expected =
      ConstMatrixView(values.data(), order(1), order(1), Eigen::OuterStride<>(padded(order(1))));
  EXPECT_TRUE(test::same_bits(square(together, 1), expected));
}

std::string name_of_products(const testing::TestParamInfo<std::tuple<Way, Shape>>& info) {
  const auto& [way, shape] = info.param;
  return std::string(way.name) + "_" + std::to_string(shape.rows) + "x" +
         std::to_string(shape.columns);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, ProductsTest,
    testing::Combine(testing::Values(Way{"cpu_own"},
                                     Way{.name = "clblast", .products = ProductPath::clblast},
                                     Way{"gpu_group", KernelForm::gpu}),
                     testing::Values(Shape{1, 1}, Shape{3, 5}, Shape{64, 64}, Shape{200, 93},
                                     Shape{61, 129}, Shape{25, 93}, Shape{17, 1})),
    name_of_products);

}  // namespace
}  // namespace moclean
