#pragma once

#include <functional>
#include <stop_token>

#include "moclean/linalg/eigensolver.hpp"
#include "moclean/linalg/products.hpp"
#include "moclean/methods/spectral/singular_value_thresholding.hpp"
#include "moclean/methods/spectral/truncated_svd.hpp"
#include "moclean/solve/problem.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::opencl {

/// Truncated SVD and singular value thresholding of many segments at once on a device, in double.
/// Singular values and vectors are those of Gram matrices, taken twice: the second is that of the
/// data expressed in the eigenvectors of the first, whose columns have about the size of the
/// singular values, so that small ones are known better. What is below 1e-7 of the largest counts
/// as zero (see weights_of()).
class SpectralSolver {
 public:
  /// Throws ArgumentError for a tuning out of its range.
  SpectralSolver(const Device& device, const Tuning& tuning);

  using Finished = std::function<void(Index)>;

  /// Bytes of device memory a segment of this size takes.
  template <class Chosen>
  std::uint64_t memory_of(Index rows, Index columns, const Chosen&) const {
    return bytes_of(rows, columns);
  }

  /// Solves the segments [first, last) of `problem` into the same segments of `solution`.
  void solve(const Problem& problem, Index first, Index last, const TruncatedSvd& method,
             Solution& solution, const Finished& finished, const std::stop_token& stop);
  void solve(const Problem& problem, Index first, Index last,
             const SingularValueThresholding& method, Solution& solution, const Finished& finished,
             const std::stop_token& stop);

 private:
  std::uint64_t bytes_of(Index rows, Index columns) const;
  template <class Chosen>
  void weigh(const SegmentBatch& data, Index first, Index last, const Chosen& method,
             Solution& solution, const Finished& finished, const std::stop_token& stop);

  const Device& device_;
  Products<double> products_;
  Eigensolver eigen_;
};

}  // namespace moclean::opencl
