#include "moclean/linalg/group_eigen.hpp"

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

using test::nan;

/// Eigenvectors in rows and eigenvalues of every matrix, with the padding.
struct GroupDecomposition {
  std::vector<Matrix> vectors;
  std::vector<Eigen::VectorXd> values;
};

// The matrices of one order, decomposed as one batch. Padding and lower triangles hold NaN at
// first, as does the result, so that what is read or not written shows.
GroupDecomposition decompose(GroupEigen& eigen, const std::vector<Matrix>& matrices) {
  const Index n = matrices.front().rows();
  const SegmentBatch shape = test::batch_of(matrices);
  const Device& device = test::device();
  const Batch batch(device, shape, 0, shape.segments());
  std::vector<double> squares(batch.square_size(), nan);
  for (Index b = 0; b < shape.segments(); ++b) {
    const SegmentRecord& s = batch.segment(b);
    MatrixView(squares.data() + s.square, n, n, Eigen::OuterStride<>(s.order_pitch))
        .triangularView<Eigen::Upper>() = matrices[static_cast<std::size_t>(b)];
  }
  Buffer<double> a(device, std::span<const double>(squares));
  std::ranges::fill(squares, nan);
  Buffer<double> z(device, std::span<const double>(squares));
  std::vector<double> values(batch.vector_size(), nan);
  Buffer<double> d(device, std::span<const double>(values));

  eigen(batch, a, z, d);
  eigen.check(batch);
  z.read(squares);
  d.read(values);

  GroupDecomposition result;
  for (Index b = 0; b < shape.segments(); ++b) {
    const SegmentRecord& s = batch.segment(b);
    result.vectors.push_back(Eigen::Map<const Matrix>(squares.data() + s.square, n, s.order_pitch));
    result.values.push_back(
        Eigen::Map<const Eigen::VectorXd>(values.data() + s.vector, s.order_pitch));
  }
  return result;
}

GroupDecomposition decompose(const GroupLimits& limits, const std::vector<Matrix>& matrices) {
  GroupEigen eigen(test::device(), limits);
  return decompose(eigen, matrices);
}

std::vector<Matrix> kinds_of_order(Index n) {
  std::vector<Matrix> matrices;
  for (const test::SymmetricKind& kind : test::symmetric_kinds()) matrices.push_back(kind.make(n));
  return matrices;
}

void expect_same_bits(const GroupDecomposition& a, const GroupDecomposition& b) {
  ASSERT_EQ(a.vectors.size(), b.vectors.size());
  for (std::size_t i = 0; i < a.vectors.size(); ++i) {
    EXPECT_TRUE(test::same_bits(a.vectors[i], b.vectors[i])) << "vectors of matrix " << i;
    EXPECT_TRUE(test::same_bits(Matrix(a.values[i]), Matrix(b.values[i]))) << "values of " << i;
  }
}

// Residual, orthogonality and order. The matrix is scaled to entries near 1 first, so that norms of
// the tiny and the huge do not leave the range.
void expect_accurate(const Matrix& matrix, const GroupDecomposition& result, std::size_t b) {
  const Index n = matrix.rows();
  const double scale = std::max(matrix.cwiseAbs().maxCoeff(), 1e-300);
  const Matrix g = matrix / scale, z = result.vectors[b].leftCols(n);
  const Eigen::VectorXd values = result.values[b].head(n) / scale;
  const Matrix residual = g * z.transpose() - z.transpose() * values.asDiagonal();
  EXPECT_LE(residual.norm(), test::tolerance::eigen_residual() * g.norm());
  EXPECT_LE((z * z.transpose() - Matrix::Identity(n, n)).norm(),
            test::tolerance::eigen_orthogonality());
  EXPECT_TRUE(std::ranges::is_sorted(values, std::greater<>()));
}

class GroupEigenTest : public testing::TestWithParam<std::tuple<int, Index>> {};

TEST_P(GroupEigenTest, DecomposesEveryKindOfMatrixToRounding) {
  const auto& [work_group, n] = GetParam();
  const std::vector<Matrix> matrices = kinds_of_order(n);

  const GroupDecomposition result = decompose({.work_group = work_group}, matrices);

  for (std::size_t b = 0; b < matrices.size(); ++b) {
    SCOPED_TRACE(test::symmetric_kinds()[b].name);
    expect_accurate(matrices[b], result, b);
    const double scale = std::max(matrices[b].cwiseAbs().maxCoeff(), 1e-300);
    const Matrix g = matrices[b] / scale;
    const Eigen::VectorXd expected = test::eigenvalues(g);
    EXPECT_LE((result.values[b].head(n) / scale - expected.reverse()).norm(),
              test::tolerance::eigen_residual() * g.norm());
  }
}

TEST(GroupEigen, DecomposesMatricesOfOrder512ToRounding) {
  std::vector<Matrix> matrices;
  for (const test::SymmetricKind& kind : test::symmetric_kinds())
    if (kind.name == "Random" || kind.name == "RankDeficient" || kind.name == "Graded")
      matrices.push_back(kind.make(512));
  ASSERT_EQ(matrices.size(), 3u);

  const GroupDecomposition result = decompose({.work_group = 256}, matrices);

  for (std::size_t b = 0; b < matrices.size(); ++b) expect_accurate(matrices[b], result, b);
}

TEST_P(GroupEigenTest, ClearsThePadding) {
  const auto& [work_group, n] = GetParam();

  const GroupDecomposition result =
      decompose({.work_group = work_group}, {test::random_symmetric(n, 11)});

  const Matrix& z = result.vectors[0];
  EXPECT_TRUE(test::same_bits(Matrix(z.rightCols(z.cols() - n)), Matrix::Zero(n, z.cols() - n)));
  EXPECT_TRUE((result.values[0].tail(z.cols() - n).array() == 0).all());
}

std::string name_of_group_eigen(const testing::TestParamInfo<std::tuple<int, Index>>& info) {
  const auto& [work_group, n] = info.param;
  return "WG" + std::to_string(work_group) + "_n" + std::to_string(n);
}

INSTANTIATE_TEST_SUITE_P(Sizes, GroupEigenTest,
                         testing::Combine(testing::Values(64, 128, 256),
                                          testing::Values<Index>(1, 2, 3, 5, 16, 31, 64, 93, 128,
                                                                 200)),
                         name_of_group_eigen);
INSTANTIATE_TEST_SUITE_P(Narrow, GroupEigenTest,
                         testing::Combine(testing::Values(1, 4), testing::Values<Index>(1, 5, 31)),
                         name_of_group_eigen);

TEST(GroupEigen, GivesTheSameBitsInLocalAndInGlobalMemory) {
  const std::vector<Matrix> matrices = kinds_of_order(93);
  GroupEigen local(test::device()), global(test::device(), {.local_memory = 8192});
  ASSERT_LE(local.local_memory(93, true), test::device().info().local_memory);
  ASSERT_GT(global.local_memory(93, true), 8192);

  const GroupDecomposition in_local = decompose(local, matrices);
  const GroupDecomposition in_global = decompose(global, matrices);

  expect_same_bits(in_local, in_global);
}

TEST(GroupEigen, OfAMatrixDoesNotDependOnItsNeighbours) {
  const std::vector<Matrix> matrices = kinds_of_order(31);
  const GroupDecomposition together = decompose({}, matrices);

  for (std::size_t b = 0; b < matrices.size(); ++b) {
    const GroupDecomposition alone = decompose({}, {matrices[b]});
    EXPECT_TRUE(test::same_bits(together.vectors[b], alone.vectors[0])) << b;
    EXPECT_TRUE(test::same_bits(Matrix(together.values[b]), Matrix(alone.values[0]))) << b;
  }
}

// Segments of 3, 20 and 9 rows with 14 columns: orders 3, 14 and 9 in one batch.
TEST(GroupEigen, DecomposesABatchOfMixedOrdersAsEachAlone) {
  const Device& device = test::device();
  const SegmentBatch shape(14, {0, 3, 23, 32});
  const Batch batch(device, shape, 0, 3);
  std::vector<Matrix> matrices;
  for (Index b = 0; b < 3; ++b)
    matrices.push_back(
        test::random_symmetric(batch.segment(b).order, static_cast<std::uint64_t>(20 + b)));
  Buffer<double> a = test::upload_squares(batch, matrices);
  Buffer<double> z(device, batch.square_size()), d(device, batch.vector_size());
  GroupEigen eigen(device);

  eigen(batch, a, z, d);
  const std::vector<Matrix> together = test::download_squares(batch, z);

  for (std::size_t b = 0; b < 3; ++b) {
    const GroupDecomposition alone = decompose(eigen, {matrices[b]});
    EXPECT_TRUE(test::same_bits(together[b], alone.vectors[0])) << "segment " << b;
  }
}

TEST(GroupEigen, LeavesSegmentsThatAreNotActiveAlone) {
  const Device& device = test::device();
  const SegmentBatch data = test::batch_of({test::random_symmetric(4, 1), Matrix::Identity(4, 4)});
  Batch batch(device, data, 0, 2);
  batch.select(std::vector<std::int32_t>{1});
  Buffer<double> a(device, std::as_const(data).storage());
  const std::vector<double> marks(batch.square_size(), 7);
  Buffer<double> z(device, std::span<const double>(marks)), d(device, batch.vector_size());
  std::vector<double> vectors(batch.square_size());

  GroupEigen eigen(device);
  eigen(batch, a, z, d);
  z.read(vectors);

  EXPECT_EQ(vectors[static_cast<std::size_t>(batch.segment(0).square)], 7);
  const Eigen::Map<const Matrix> z1(vectors.data() + batch.segment(1).square, 4, padded(4));
  EXPECT_EQ(z1.cwiseAbs().sum(), 4);  // a permutation of the identity, padding zero
}

TEST(GroupEigen, WritesTheWantedVectorsOnly) {
  const Device& device = test::device();
  const SegmentBatch data = test::batch_of({test::random_symmetric(9, 1)});
  const Batch batch(device, data, 0, 1);
  Buffer<double> a(device, std::as_const(data).storage());
  const std::vector<double> marks(batch.square_size(), 7);
  Buffer<double> z(device, std::span<const double>(marks)), d(device, batch.vector_size());
  const std::vector<std::int32_t> four = {4};
  const Buffer<std::int32_t> wanted(device, std::span<const std::int32_t>(four));
  std::vector<double> squares(batch.square_size());
  GroupEigen eigen(device);
  const Matrix all = decompose(eigen, {Matrix(data.segment(0))}).vectors[0];

  eigen.values(batch, wanted, a, d);
  eigen.vectors(batch, wanted, z);
  z.read(squares);

  const Eigen::Map<const Matrix> rows(squares.data(), 9, batch.segment(0).order_pitch);
  EXPECT_TRUE(test::same_bits(Matrix(rows.topRows(4)), Matrix(all.topRows(4))));
  EXPECT_TRUE((rows.bottomRows(5).array() == 7).all());
}

// Of two segments the second is decomposed again, as another matrix; the first keeps its own.
TEST(GroupEigen, KeepsWhatItHasOfSegmentsThatAreNotChosen) {
  const Device& device = test::device();
  const Matrix first = test::random_symmetric(6, 1), second = test::random_symmetric(6, 2);
  const Matrix third = test::random_symmetric(6, 3);
  const SegmentBatch before = test::batch_of({first, second}),
                     after = test::batch_of({second, third});
  const Batch batch(device, before, 0, 2);
  Buffer<double> a(device, std::as_const(before).storage());
  Buffer<double> z(device, batch.square_size()), d(device, batch.vector_size());
  const std::vector<std::int32_t> only_second = {0, 1};
  const Buffer<std::int32_t> chosen(device, std::span<const std::int32_t>(only_second));
  std::vector<double> vectors(batch.square_size());
  GroupEigen eigen(device);
  const GroupDecomposition expected = decompose({}, {first, third});

  eigen(batch, a, z, d);
  a.write(std::as_const(after).storage());
  eigen.values(batch, chosen, a, d);
  eigen.all_vectors(batch, z);
  z.read(vectors);

  for (Index b = 0; b < 2; ++b) {
    const Eigen::Map<const Matrix> zb(vectors.data() + batch.segment(b).square, 6, padded(6));
    EXPECT_TRUE(test::same_bits(Matrix(zb), expected.vectors[static_cast<std::size_t>(b)])) << b;
  }
}

// Gram matrices of X diag(g), g from 1 to 1e-8: the eigenvalues span 16 decades, and those of the
// Gram matrix are lost below 1e-16 of the largest unless the grading is respected. What is right is
// said by the one-sided Jacobi SVD of the factor, which is accurate for such matrices.
TEST(GroupEigen, KeepsSmallEigenvaluesOfGradedMatricesToRelativeAccuracy) {
  constexpr Index n = 60;
  Matrix factor = test::random_matrix(200, n, 10);
  for (Index j = 0; j < n; ++j)
    factor.col(j) *= std::pow(10, -8.0 * static_cast<double>(j) / (n - 1));
  const Eigen::VectorXd sigma = test::singular_values(factor);

  const GroupDecomposition result = decompose({}, {Matrix(factor.transpose() * factor)});

  for (Index k = 0; k < n; ++k)
    EXPECT_NEAR(std::sqrt(result.values[0](k)), sigma(k),
                test::tolerance::decomposition(200) * sigma(k));
}

TEST(GroupEigen, SolvesAMatrixByHand) {
  const Matrix matrix{{2, 1, 0}, {1, 3, 1}, {0, 1, 4}};  // eigenvalues 3 and 3 +- sqrt(3)

  const GroupDecomposition result = decompose({}, {matrix});

  EXPECT_NEAR(result.values[0](0), 3 + std::sqrt(3.0), test::tolerance::by_hand(4));
  EXPECT_NEAR(result.values[0](1), 3, test::tolerance::by_hand(4));
  EXPECT_NEAR(result.values[0](2), 3 - std::sqrt(3.0), test::tolerance::by_hand(4));
}

// 48 KiB is what most devices offer; the packed triangle of 93 x 93 takes 34 968 bytes of it.
TEST(GroupEigen, FitsTheUsualMatrixIntoFortyEightKilobytes) {
  const GroupEigen eigen(test::device(), {.work_group = 128});

  EXPECT_EQ(eigen.local_memory(93, true), 34968u + 4 * 96 * 8 + 128 * 8);
  EXPECT_LE(eigen.local_memory(105, true), 48u * 1024);
  EXPECT_GT(eigen.local_memory(106, true), 48u * 1024);
}

TEST(GroupEigen, TakesNoMoreWorkItemsThanTheDeviceHas) {
  const GroupEigen eigen(test::device(), {.work_group = 1 << 30});

  EXPECT_LE(static_cast<std::size_t>(eigen.work_group()), test::device().info().max_work_group);
}

TEST(GroupEigen, RefusesAMatrixTooLargeForLocalMemory) {
  const std::vector<Matrix> matrices = {Matrix::Identity(200, 200)};

  EXPECT_THROW(decompose({.work_group = 8, .local_memory = 8192}, matrices), DeviceError);
}

TEST(GroupEigen, ReportsAMatrixItCannotDecompose) {
  const std::vector<Matrix> matrices = {Matrix::Identity(5, 5), Matrix::Constant(5, 5, nan)};

  EXPECT_THROW(decompose({}, matrices), DeviceError);
}

}  // namespace
}  // namespace moclean
