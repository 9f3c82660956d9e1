#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "moclean/core/segment_batch.hpp"
#include "moclean/solve/robust_pca.hpp"

namespace moclean {

/// What is computed. A method missing on one backend does not compile (std::visit).
using Method = std::variant<RobustPca>;

/// How the solution of one segment came about.
struct SegmentOutcome {
  int iterations = 0;
  int rank = 0;         ///< singular values of the last X above 1/mu
  double residual = 0;  ///< |D - A - E|_F / |D|_F after the last iteration; 0 for a zero segment
  bool converged = false;
};

/// D = low_rank + sparse, segment by segment, in the layout of the data.
struct Solution {
  SegmentBatch low_rank;  ///< A
  SegmentBatch sparse;    ///< E
  std::vector<SegmentOutcome> segments;
};

/// Segments finished so far, of how many.
struct Progress {
  Index finished = 0;
  Index total = 0;
};

/// What a caller may want while a backend works.
struct Monitor {
  std::function<void(const Progress&)> report = {};  ///< called from one thread at a time
  std::stop_token stop = {};  ///< when requested, solve throws Cancelled soon
};

/// Largest magnitude of an entry the backends accept: sums of its squares stay finite.
inline constexpr double largest_entry = 1e140;

/// Throws ShapeError naming segment, row and column (from 0) of the first entry that is NaN,
/// infinite or larger than `largest_entry`. Every backend calls it before it computes anything.
void require_finite(const SegmentBatch& data);

/// Where a method is computed.
class Backend {
 public:
  virtual ~Backend() = default;

  /// For reports: "reference (Eigen 3.4.0, 2 threads)", "opencl (<device>)".
  virtual std::string name() const = 0;

  /// Solves every segment. The result of a segment depends on its own data and the method only, bit
  /// for bit: not on its neighbours or its place in the batch. Throws ShapeError naming row and
  /// column if the data holds NaN or infinity, ArgumentError for parameters out of range,
  /// Cancelled.
  virtual Solution solve(const SegmentBatch& data, const Method& method,
                         const Monitor& monitor = {}) = 0;
};

}  // namespace moclean
