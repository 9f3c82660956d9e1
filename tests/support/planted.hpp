#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "moclean/core/random.hpp"

#include "support/matrix.hpp"

namespace moclean::test {

/// What a planted problem is made of.
struct PlantedOptions {
  Index rows = 60;
  Index columns = 40;
  Index rank = 3;
  double error_share = 0.05;  ///< share of the entries with a gross error, rounded to whole entries
  double error_size = 10;     ///< gross errors are uniform on [-error_size, error_size]
  std::uint64_t seed = 1;
};

/// A matrix of which the low-rank and the sparse part are known.
struct Planted {
  Matrix
      low_rank;  ///< U V' with standard normal factors of `rank` columns; entries of variance rank
  Matrix sparse;

  Matrix data() const { return low_rank + sparse; }
};

inline Planted planted(const PlantedOptions& options) {
  const Matrix u = random_matrix(options.rows, options.rank, 3 * options.seed);
  const Matrix v = random_matrix(options.columns, options.rank, 3 * options.seed + 1);
  Random random(3 * options.seed + 2);
  const Index entries = options.rows * options.columns;
  const auto errors = std::llround(options.error_share * static_cast<double>(entries));

  Planted problem{u * v.transpose(), Matrix::Zero(options.rows, options.columns)};
  for (const Index i : random.choose(errors, entries))
    problem.sparse.reshaped<Eigen::RowMajor>()(i) = options.error_size * (2 * random.uniform() - 1);
  return problem;
}

/// A ragged batch of planted problems, one of each length, seeds counting up from options.seed.
inline SegmentBatch planted_batch(PlantedOptions options, const std::vector<Index>& lengths) {
  std::vector<Matrix> segments;
  for (const Index length : lengths) {
    options.rows = length;
    segments.push_back(planted(options).data());
    ++options.seed;
  }
  return batch_of(segments);
}

}  // namespace moclean::test
