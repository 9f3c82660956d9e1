#include "moclean/linalg/eigen.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/decompositions.hpp"
#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/squares.hpp"
#include "support/symmetric.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

// Eigenvectors in rows and eigenvalues of every matrix.
struct Decomposition {
  std::vector<Matrix> vectors;
  std::vector<Eigen::VectorXd> values;
};

// Matrices of any orders as one batch, and the results read back.
class EigenBatch {
 public:
  explicit EigenBatch(const std::vector<Matrix>& matrices)
      : batch_(test::device(), shape_of(matrices), 0, static_cast<Index>(matrices.size())),
        a_(test::upload_squares(batch_, matrices)),
        z_(test::device(), batch_.square_size()),
        values_(test::device(), batch_.vector_size()) {
    z_.fill_zero();
    values_.fill_zero();
  }

  Decomposition all() {
    eigen_(batch_, a_, z_, values_);
    return result();
  }

  // As the solver does it: eigenvalues of the chosen ones, then the leading eigenvectors.
  Decomposition leading(const std::vector<std::int32_t>& chosen,
                        const std::vector<std::int32_t>& wanted) {
    eigen_.values(batch_, Buffer<std::int32_t>(test::device(), std::span(chosen)), a_, values_);
    eigen_.vectors(batch_, Buffer<std::int32_t>(test::device(), std::span(wanted)), a_, z_);
    return result();
  }

  void rewrite(const std::vector<Matrix>& matrices) { a_ = test::upload_squares(batch_, matrices); }

 private:
  // Segments of as many rows as a matrix has, which are not more than there are columns.
  static SegmentBatch shape_of(const std::vector<Matrix>& matrices) {
    Index columns = 0;
    std::vector<Index> first_row = {0};
    for (const Matrix& matrix : matrices) {
      columns = std::max(columns, matrix.rows());
      first_row.push_back(first_row.back() + matrix.rows());
    }
    return {columns, first_row};
  }

  Decomposition result() {
    eigen_.check(batch_);
    std::vector<double> values(batch_.vector_size());
    values_.read(values);
    Decomposition d{.vectors = test::download_squares(batch_, z_), .values = {}};
    for (Index b = 0; b < batch_.segments(); ++b) {
      const SegmentRecord& s = batch_.segment(b);
      Matrix& vectors = d.vectors[static_cast<std::size_t>(b)];
      vectors = Matrix(vectors.leftCols(s.order));
      d.values.push_back(Eigen::Map<const Eigen::VectorXd>(values.data() + s.vector, s.order));
    }
    return d;
  }

  Batch batch_;
  Buffer<double> a_, z_, values_;
  SymmetricEigen eigen_{test::device()};
};

std::vector<Matrix> every_kind(Index n) {
  std::vector<Matrix> matrices;
  for (const test::SymmetricKind& kind : test::symmetric_kinds()) matrices.push_back(kind.make(n));
  return matrices;
}

class SymmetricEigenTest : public testing::TestWithParam<int> {};

TEST_P(SymmetricEigenTest, DecomposesEveryKindOfMatrixToRounding) {
  const Index n = GetParam();
  const std::vector<Matrix> matrices = every_kind(n);

  const Decomposition result = EigenBatch(matrices).all();

  for (std::size_t b = 0; b < matrices.size(); ++b) {
    SCOPED_TRACE(test::symmetric_kinds()[b].name);
    // Scaled to entries near 1, so that norms of the tiny and the huge do not leave the range.
    const double scale = std::max(matrices[b].cwiseAbs().maxCoeff(), 1e-300);
    const Matrix g = matrices[b] / scale, &z = result.vectors[b];
    const Eigen::VectorXd values = result.values[b] / scale;
    const Matrix residual = g * z.transpose() - z.transpose() * values.asDiagonal();
    EXPECT_TRUE(std::ranges::is_sorted(values, std::greater<>()));
    EXPECT_LE(residual.norm(), test::tolerance::eigen_residual() * g.norm());
    EXPECT_LE((z * z.transpose() - Matrix::Identity(n, n)).norm(),
              test::tolerance::eigen_orthogonality());
  }
}

TEST_P(SymmetricEigenTest, LeadingEigenvectorsAreThoseOfTheWholeDecomposition) {
  const Index n = GetParam();
  const std::vector<Matrix> matrices = every_kind(n);
  const auto count = static_cast<std::int32_t>((n + 1) / 2);
  const std::vector<std::int32_t> all(matrices.size(), 1), wanted(matrices.size(), count);

  const Decomposition whole = EigenBatch(matrices).all();
  const Decomposition part = EigenBatch(matrices).leading(all, wanted);

  for (std::size_t b = 0; b < matrices.size(); ++b) {
    SCOPED_TRACE(test::symmetric_kinds()[b].name);
    EXPECT_TRUE(test::same_bits(Matrix(whole.values[b]), Matrix(part.values[b])));
    EXPECT_TRUE(test::same_bits(Matrix(whole.vectors[b].topRows(count)),
                                Matrix(part.vectors[b].topRows(count))));
    EXPECT_EQ(part.vectors[b].bottomRows(n - count).cwiseAbs().sum(), 0) << "rows not wanted";
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SymmetricEigenTest,
                         testing::Values(1, 2, 3, 5, 7, 8, 9, 31, 64, 93, 129, 512),
                         testing::PrintToStringParamName());

// Lanes of a vector hold different matrices; orders differ, so lanes end at different times.
TEST(SymmetricEigen, ResultsDoNotDependOnTheNeighbours) {
  std::vector<Matrix> matrices;
  for (const Index n : {7, 1, 93, 20, 64, 2, 31, 5, 50, 93, 3})
    matrices.push_back(test::random_gram(2 * n, n, static_cast<std::uint64_t>(n)));

  const Decomposition together = EigenBatch(matrices).all();

  for (std::size_t b = 0; b < matrices.size(); ++b) {
    const Decomposition alone = EigenBatch({matrices[b]}).all();
    EXPECT_TRUE(test::same_bits(together.vectors[b], alone.vectors[0])) << "matrix " << b;
    EXPECT_TRUE(test::same_bits(Matrix(together.values[b]), Matrix(alone.values[0])));
  }
}

TEST(SymmetricEigen, LeavesAloneWhatIsNotChosen) {
  const std::vector<Matrix> first = {test::random_gram(40, 20, 1), test::random_gram(40, 20, 2)};
  const std::vector<Matrix> second = {test::random_gram(40, 20, 3), test::random_gram(40, 20, 4)};
  EigenBatch batch(first);
  const Decomposition before = batch.leading({1, 1}, {4, 4});

  batch.rewrite(second);
  const Decomposition after = batch.leading({0, 1}, {6, 6});

  const Decomposition whole = EigenBatch(first).all(), fresh = EigenBatch(second).all();
  EXPECT_TRUE(test::same_bits(Matrix(after.values[0]), Matrix(before.values[0])));
  EXPECT_TRUE(test::same_bits(Matrix(after.vectors[0].topRows(6)),  // two more than before
                              Matrix(whole.vectors[0].topRows(6))));
  EXPECT_TRUE(test::same_bits(Matrix(after.values[1]), Matrix(fresh.values[1])));
}

TEST(SymmetricEigen, ReadsTheUpperTriangleOnly) {
  Matrix upper(2, 2);
  upper << 2, 1, 777, 2;  // the eigenvalues of [2 1; 1 2] are 1 and 3

  const Eigen::VectorXd values = EigenBatch({upper}).all().values[0];

  EXPECT_NEAR(values(0), 3, test::tolerance::by_hand(3));
  EXPECT_NEAR(values(1), 1, test::tolerance::by_hand(3));
}

// Gram matrices of X diag(g), g from 1 to 1e-8: the eigenvalues span 16 decades, and those of the
// Gram matrix are lost below 1e-16 of the largest unless the grading is respected. What is right is
// said by the one-sided Jacobi SVD of the factor, which is accurate for such matrices.
TEST(SymmetricEigen, KeepsSmallEigenvaluesOfGradedMatricesToRelativeAccuracy) {
  constexpr Index n = 60;
  Matrix factor = test::random_matrix(200, n, 10);
  for (Index j = 0; j < n; ++j)
    factor.col(j) *= std::pow(10, -8.0 * static_cast<double>(j) / (n - 1));
  const Eigen::VectorXd sigma = test::singular_values(factor);

  const Eigen::VectorXd values = EigenBatch({Matrix(factor.transpose() * factor)}).all().values[0];

  for (Index k = 0; k < n; ++k)
    EXPECT_NEAR(std::sqrt(values(k)), sigma(k), test::tolerance::decomposition(200) * sigma(k));
}

TEST(SymmetricEigen, DoesNotReadThePadding) {
  const Device& device = test::device();
  const SegmentBatch shape(3, {0, 3});
  const Batch batch(device, shape, 0, 1);
  const auto pitch = static_cast<Index>(padded(3));
  std::vector<double> matrix(batch.square_size(), test::nan);
  const Eigen::Matrix3d expected{{2, 1, 0}, {1, 3, 1}, {0, 1, 4}};
  for (Index i = 0; i < 3; ++i)
    for (Index j = i; j < 3; ++j) matrix[static_cast<std::size_t>(pitch * i + j)] = expected(i, j);
  Buffer<double> a(device, std::span<const double>(matrix)), z(device, batch.square_size());
  Buffer<double> d(device, batch.vector_size());
  std::vector<double> values(batch.vector_size());

  SymmetricEigen eigen(device);
  eigen(batch, a, z, d);
  d.read(values);

  EXPECT_NEAR(values[0], 3 + std::sqrt(3.0), test::tolerance::by_hand(4));
  EXPECT_NEAR(values[1], 3, test::tolerance::by_hand(4));
  EXPECT_NEAR(values[2], 3 - std::sqrt(3.0), test::tolerance::by_hand(4));
}

TEST(SymmetricEigen, ReportsAMatrixItCannotDecompose) {
  EigenBatch batch({Matrix::Identity(5, 5), Matrix::Constant(5, 5, test::nan)});

  EXPECT_THROW(batch.all(), DeviceError);
}

}  // namespace
}  // namespace moclean
