#include "moclean/linalg/eigen.hpp"

#include <functional>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

// Q diag(values) Q' with a random orthogonal Q.
Matrix with_spectrum(const Eigen::VectorXd& values, std::uint64_t seed) {
  const Matrix random = test::random_matrix(values.size(), values.size(), seed);
  const Matrix q = Eigen::HouseholderQR<Matrix>(random).householderQ();
  return q * values.asDiagonal() * q.transpose();
}

struct Kind {
  const char* name;
  std::function<Matrix(Index)> make;
};

const std::vector<Kind>& kinds() {
  using Eigen::VectorXd;
  static const std::vector<Kind> all = {
      {"Random",
       [](Index n) {
         const Matrix r = test::random_matrix(n, n, 5);
         return Matrix(r + r.transpose());
       }},
      {"Gram",
       [](Index n) {
         const Matrix r = test::random_matrix(3 * n, n, 6);
         return Matrix(r.transpose() * r);
       }},
      {"RankDeficient",
       [](Index n) {
         const Matrix r = test::random_matrix((n + 2) / 3, n, 7);
         return Matrix(r.transpose() * r);
       }},
      {"Clustered",
       [](Index n) {
         VectorXd values = VectorXd::Constant(n, 1);
         values.head(n / 2).array() += 1e-10;
         return with_spectrum(values, 8);
       }},
      {"Graded",
       [](Index n) {
         VectorXd values(n);
         for (Index i = 0; i < n; ++i)
           values(i) = std::pow(10, -16.0 * static_cast<double>(i) / static_cast<double>(n));
         return with_spectrum(values, 9);
       }},
      {"Diagonal", [](Index n) { return Matrix(VectorXd::LinSpaced(n, -3, 5).asDiagonal()); }},
      {"Zero", [](Index n) { return Matrix(Matrix::Zero(n, n)); }},
      {"Constant", [](Index n) { return Matrix(Matrix::Constant(n, n, 2)); }},
      {"Tiny", [](Index n) { return Matrix(1e-200 * kinds()[0].make(n)); }},
      {"Huge", [](Index n) { return Matrix(1e200 * kinds()[0].make(n)); }},
  };
  return all;
}

class SymmetricEigenTest : public testing::TestWithParam<int> {};

TEST_P(SymmetricEigenTest, DecomposesEveryKindOfMatrixToRounding) {
  const Index n = GetParam();
  std::vector<Matrix> matrices;
  for (const Kind& kind : kinds()) matrices.push_back(kind.make(n));
  const SegmentBatch data = test::batch_of(matrices);
  const Device& device = test::device();
  const Batch batch(device, data, 0, data.segments());
  Buffer<double> a(device, std::as_const(data).storage());  // a square segment is laid out alike
  Buffer<double> z(device, batch.square_size()), d(device, batch.vector_size());
  std::vector<double> vectors(batch.square_size()), values(batch.vector_size());

  SymmetricEigen eigen(device);
  eigen(batch, a, z, d);
  eigen.check(batch);
  z.read(vectors);
  d.read(values);

  for (Index b = 0; b < data.segments(); ++b) {
    SCOPED_TRACE(kinds()[static_cast<std::size_t>(b)].name);
    const SegmentRecord& s = batch.segment(b);
    const Matrix& matrix = matrices[static_cast<std::size_t>(b)];
    const Matrix zb =
        ConstMatrixView(vectors.data() + s.square, n, n, Eigen::OuterStride<>(s.order_pitch));
    const Eigen::Map<const Eigen::VectorXd> db(values.data() + s.vector, n);
    EXPECT_TRUE(std::is_sorted(db.begin(), db.end(), std::greater<>()));
    // Scaled to entries near 1, so that norms of the tiny and the huge do not leave the range.
    const double scale = std::max(matrix.cwiseAbs().maxCoeff(), 1e-300);
    const Matrix residual =
        (matrix / scale) * zb.transpose() - zb.transpose() * (db / scale).asDiagonal();
    EXPECT_LE(residual.norm(), test::tolerance::decomposition(n) * (matrix / scale).norm());
    EXPECT_LE((zb * zb.transpose() - Matrix::Identity(n, n)).norm(),
              test::tolerance::decomposition(n) * std::sqrt(static_cast<double>(n)));
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SymmetricEigenTest,
                         testing::Values(1, 2, 3, 5, 7, 8, 9, 31, 64, 93, 129, 512),
                         testing::PrintToStringParamName());

TEST(SymmetricEigen, ReadsTheUpperTriangleOnly) {
  Matrix upper(2, 2);
  upper << 2, 1, 777, 2;  // the eigenvalues of [2 1; 1 2] are 1 and 3
  const SegmentBatch data = test::batch_of({upper});
  const Device& device = test::device();
  const Batch batch(device, data, 0, 1);
  Buffer<double> a(device, std::as_const(data).storage()), z(device, 16), d(device, 8);
  std::vector<double> values(8);

  SymmetricEigen eigen(device);
  eigen(batch, a, z, d);
  d.read(values);

  EXPECT_NEAR(values[0], 3, test::tolerance::by_hand(3));
  EXPECT_NEAR(values[1], 1, test::tolerance::by_hand(3));
}

// Gram matrices of X diag(g), g from 1 to 1e-8: the eigenvalues span 16 decades, and those of the
// Gram matrix are lost below 1e-16 of the largest unless the grading is respected. What is right is
// said by the one-sided Jacobi SVD of the factor, which is accurate for such matrices.
TEST(SymmetricEigen, KeepsSmallEigenvaluesOfGradedMatricesToRelativeAccuracy) {
  constexpr Index n = 60;
  Matrix factor = test::random_matrix(200, n, 10);
  for (Index j = 0; j < n; ++j)
    factor.col(j) *= std::pow(10, -8.0 * static_cast<double>(j) / (n - 1));
  const SegmentBatch data = test::batch_of({Matrix(factor.transpose() * factor)});
  const Eigen::VectorXd sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(factor).singularValues();
  const Device& device = test::device();
  const Batch batch(device, data, 0, 1);
  Buffer<double> a(device, std::as_const(data).storage());
  Buffer<double> z(device, batch.square_size()), d(device, batch.vector_size());
  std::vector<double> values(batch.vector_size());

  SymmetricEigen eigen(device);
  eigen(batch, a, z, d);
  d.read(values);

  for (Index k = 0; k < n; ++k)
    EXPECT_NEAR(std::sqrt(values[static_cast<std::size_t>(k)]), sigma(k),
                test::tolerance::decomposition(200) * sigma(k));
}

TEST(SymmetricEigen, DoesNotReadThePadding) {
  const Device& device = test::device();
  const SegmentBatch shape(3, {0, 3});
  const Batch batch(device, shape, 0, 1);
  std::vector<double> matrix(24, std::numeric_limits<double>::quiet_NaN());
  const Eigen::Matrix3d expected{{2, 1, 0}, {1, 3, 1}, {0, 1, 4}};
  for (Index i = 0; i < 3; ++i)
    for (Index j = i; j < 3; ++j) matrix[static_cast<std::size_t>(8 * i + j)] = expected(i, j);
  Buffer<double> a(device, std::span<const double>(matrix)), z(device, 24), d(device, 8);
  std::vector<double> values(8);

  SymmetricEigen eigen(device);
  eigen(batch, a, z, d);
  d.read(values);

  EXPECT_NEAR(values[0], 3 + std::sqrt(3.0), test::tolerance::by_hand(4));
  EXPECT_NEAR(values[1], 3, test::tolerance::by_hand(4));
  EXPECT_NEAR(values[2], 3 - std::sqrt(3.0), test::tolerance::by_hand(4));
}

TEST(SymmetricEigen, ReportsAMatrixItCannotDecompose) {
  const SegmentBatch data = test::batch_of(
      {Matrix::Identity(5, 5), Matrix::Constant(5, 5, std::numeric_limits<double>::quiet_NaN())});
  const Device& device = test::device();
  const Batch batch(device, data, 0, 2);
  Buffer<double> a(device, std::as_const(data).storage());
  Buffer<double> z(device, batch.square_size()), d(device, batch.vector_size());

  SymmetricEigen eigen(device);
  eigen(batch, a, z, d);

  EXPECT_THROW(eigen.check(batch), DeviceError);
}

}  // namespace
}  // namespace moclean
