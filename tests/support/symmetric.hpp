#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/decompositions.hpp"
#include "support/matrix.hpp"

namespace moclean::test {

/// A family of symmetric matrices [n x n] that is known to trouble eigensolvers.
struct SymmetricKind {
  std::string name;
  std::function<Matrix(Index)> make;
};

/// Q diag(values) Q' with a random orthogonal Q.
inline Matrix with_spectrum(const Eigen::VectorXd& values, std::uint64_t seed) {
  const Matrix random = random_matrix(values.size(), values.size(), seed);
  const Matrix q = orthogonal_factor(random);
  return q * values.asDiagonal() * q.transpose();
}

/// Decreases from 1 to 1e-16 in equal ratios.
inline Eigen::VectorXd graded_values(Index n) {
  Eigen::VectorXd values(n);
  for (Index i = 0; i < n; ++i)
    values(i) = std::pow(
        10, -16.0 * static_cast<double>(i) / static_cast<double>(std::max<Index>(1, n - 1)));
  return values;
}

inline Matrix random_symmetric(Index n, std::uint64_t seed) {
  const Matrix r = random_matrix(n, n, seed);
  return r + r.transpose();
}

inline Matrix random_gram(Index rows, Index n, std::uint64_t seed) {
  const Matrix r = random_matrix(rows, n, seed);
  return r.transpose() * r;
}

inline std::vector<SymmetricKind> symmetric_kinds() {
  using Eigen::VectorXd;
  const auto clustered = [](Index n) {
    VectorXd values = VectorXd::Constant(n, 1);
    values.head(n / 2).array() += 1e-10;
    return with_spectrum(values, 8);
  };
  return {
      {"Random", [](Index n) { return random_symmetric(n, 5); }},
      {"Gram", [](Index n) { return random_gram(3 * n, n, 6); }},
      {"RankDeficient", [](Index n) { return random_gram((n + 2) / 3, n, 7); }},
      {"Clustered", clustered},
      {"Graded", [](Index n) { return with_spectrum(graded_values(n), 9); }},
      {"Diagonal", [](Index n) { return Matrix(VectorXd::LinSpaced(n, -3, 5).asDiagonal()); }},
      {"GradedDiagonal", [](Index n) { return Matrix(graded_values(n).asDiagonal()); }},
      {"Zero", [](Index n) { return Matrix(Matrix::Zero(n, n)); }},
      {"Constant", [](Index n) { return Matrix(Matrix::Constant(n, n, 2)); }},
      {"Tiny", [](Index n) { return Matrix(1e-200 * random_symmetric(n, 5)); }},
      {"Huge", [](Index n) { return Matrix(1e200 * random_symmetric(n, 5)); }},
  };
}

}  // namespace moclean::test
