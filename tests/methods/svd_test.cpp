#include <gtest/gtest.h>

#include "moclean/solve/reference_svd.hpp"

#include "support/decompositions.hpp"
#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean::reference {
namespace {

using Eigen::MatrixXd;

void expect_decomposes(const MatrixXd& x) {
  const Svd svd = thin_svd(x);

  const Index k = std::min(x.rows(), x.cols());
  const double bound = test::tolerance::decomposition(std::max(x.rows(), x.cols()));
  const MatrixXd identity = MatrixXd::Identity(k, k);
  ASSERT_EQ(svd.u.rows(), x.rows());
  ASSERT_EQ(svd.u.cols(), k);
  ASSERT_EQ(svd.v.rows(), x.cols());
  ASSERT_EQ(svd.v.cols(), k);
  const MatrixXd product = svd.u * svd.sigma.asDiagonal() * svd.v.transpose();
  EXPECT_LE((product - x).norm(), bound * x.norm());
  EXPECT_LE((svd.u.transpose() * svd.u - identity).norm(), bound);
  EXPECT_LE((svd.v.transpose() * svd.v - identity).norm(), bound);
  EXPECT_TRUE((svd.sigma.array() >= 0).all());
  for (Index i = 1; i < k; ++i) EXPECT_LE(svd.sigma(i), svd.sigma(i - 1));

  const Eigen::VectorXd jacobi = test::singular_values(x);
  EXPECT_LE((svd.sigma - jacobi).cwiseAbs().maxCoeff(), bound * jacobi(0));
}

class ThinSvd : public testing::TestWithParam<std::pair<Index, Index>> {};

TEST_P(ThinSvd, MatchesJacobiAndMultipliesToTheMatrix) {
  const auto [rows, columns] = GetParam();
  expect_decomposes(test::random_matrix(rows, columns, 1));
}

TEST_P(ThinSvd, MatchesJacobiOnARankDeficientMatrix) {
  const auto [rows, columns] = GetParam();
  expect_decomposes(test::random_matrix(rows, 1, 1) * test::random_matrix(1, columns, 2));
}

TEST_P(ThinSvd, MatchesJacobiOnRepeatedSingularValues) {
  const auto [rows, columns] = GetParam();
  expect_decomposes(MatrixXd::Identity(rows, columns));
}

TEST_P(ThinSvd, MatchesJacobiOnSmallAndLargeEntries) {
  const auto [rows, columns] = GetParam();
  expect_decomposes(1e-140 * test::random_matrix(rows, columns, 3));
  expect_decomposes(1e140 * test::random_matrix(rows, columns, 4));
}

TEST_P(ThinSvd, DecomposesZero) {
  const auto [rows, columns] = GetParam();
  expect_decomposes(MatrixXd::Zero(rows, columns));
}

INSTANTIATE_TEST_SUITE_P(Shapes, ThinSvd,
                         testing::Values(std::pair{1, 1}, std::pair{3, 5}, std::pair{1, 7},
                                         std::pair{40, 1}, std::pair{16, 16}, std::pair{64, 64},
                                         std::pair{200, 93}, std::pair{61, 129},
                                         std::pair{25, 93}));

TEST(ThinSvd, FindsTheValuesOfACalculationOnPaper) {
  const Svd svd = thin_svd(MatrixXd{{3, 0}, {4, 5}});  // X'X = (25 20; 20 25): 45 and 5

  EXPECT_NEAR(svd.sigma(0), std::sqrt(45), test::tolerance::by_hand(7));
  EXPECT_NEAR(svd.sigma(1), std::sqrt(5), test::tolerance::by_hand(7));
}

// Entries 1 and 1e-9: the Gram matrix would lose the smaller value among its roundings.
TEST(ThinSvd, KeepsSmallSingularValuesThatAGramMatrixLoses) {
  const MatrixXd x{{1, 1}, {0, 1e-9}, {0, 0}};  // sigma_1 sigma_2 = 1e-9, sigma_1 = sqrt 2

  const Svd svd = thin_svd(x);

  EXPECT_NEAR(svd.sigma(1), 1e-9 / std::sqrt(2), test::tolerance::by_hand(1));
}

}  // namespace
}  // namespace moclean::reference
