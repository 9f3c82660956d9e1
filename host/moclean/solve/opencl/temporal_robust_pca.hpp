#pragma once

#include <functional>
#include <stop_token>

#include "moclean/linalg/banded.hpp"
#include "moclean/linalg/eigensolver.hpp"
#include "moclean/linalg/products.hpp"
#include "moclean/solve/backend.hpp"

namespace moclean::opencl {

/// Robust PCA with a second-difference penalty of many segments at once on a device, in double; the
/// steps are those of solve/reference/temporal_robust_pca.cpp, in the same order. The host looks at
/// the singular values of every iteration and asks for the vectors of those above nu/mu only.
class TemporalRobustPcaSolver {
 public:
  /// Throws ArgumentError for a tuning out of its range.
  TemporalRobustPcaSolver(const Device& device, const Tuning& tuning);

  using Finished = std::function<void(Index)>;

  /// Bytes of device memory a segment of this size takes.
  std::uint64_t memory_of(Index rows, Index columns, const TemporalRobustPca& method) const;

  /// Solves the segments [first, last) of `data` into the same segments of `solution`.
  void solve(const SegmentBatch& data, Index first, Index last, const TemporalRobustPca& method,
             Solution& solution, const Finished& finished, const std::stop_token& stop);

 private:
  struct Run;

  void start(Run& run, const TemporalRobustPca& method);
  void update_smooth(Run& run);
  void update_low_rank(Run& run, const TemporalRobustPca& method);
  void update_sparse(Run& run, const TemporalRobustPca& method);
  Index retire(Run& run, const TemporalRobustPca& method);

  const Device& device_;
  Products products_;
  Eigensolver eigen_;
  Banded<double> banded_;
  Program program_;
  Kernel shift_, update_;
};

}  // namespace moclean::opencl
