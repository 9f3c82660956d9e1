#pragma once

#include <functional>
#include <mutex>
#include <stop_token>
#include <string>

#include "moclean/backend/method.hpp"
#include "moclean/solve/problem.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean {

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

/// The monitor of one part of some work, whose progress comes on top of that `before` it: reports
/// before.finished + own of before.total, as they are then. Both outlive it.
Monitor part_of(const Monitor& whole, const Progress& before);

/// Counts the segments that are finished, on any thread, and reports them one call at a time.
class FinishedCount {
 public:
  FinishedCount(const Monitor& monitor, Index total)
      : monitor_(monitor), progress_{.finished = 0, .total = total} {}

  void operator()(Index more);

 private:
  const Monitor& monitor_;
  std::mutex reporting_;
  Progress progress_;
};

/// Throws ShapeError naming segment, row and column (from 0) of the first entry that is NaN,
/// infinite or larger than `largest_entry`.
void require_finite(const SegmentBatch& data);

/// The same, but lets NaN pass if the method accepts it; throws ArgumentError for priors that the
/// method does not take, or that are not one per segment. Every backend calls it before it computes
/// anything.
void require_usable(const Problem& problem, const Method& method);

/// Room for the solution of a batch, with the parts that the method tells; all zero.
Solution room_for_solution(const SegmentBatch& data, const Method& method);

/// What decides how work is best put together for a backend. No result depends on it.
struct BackendTraits {
  Index least_segments = 64;  ///< at once, to keep it busy
  Index full_segments = 64;   ///< at once, beyond which it gets no faster; not below the least
  bool mixed = false;         ///< some matrices are float: it agrees with others so far only
};

/// How many segments fill a compute unit or a thread of a backend.
inline constexpr Index segments_per_unit = 32;

/// Where a method is computed.
class Backend {
 public:
  virtual ~Backend() = default;

  /// For reports: "reference (Eigen 3.4.0, 2 threads)", "opencl (<device>)".
  virtual std::string name() const = 0;

  virtual BackendTraits traits() const { return {}; }

  /// Gets ready for a method: compiles its kernels, say. solve() does that otherwise when it meets
  /// the method first. Nothing is asked of the method's parameters.
  virtual void prepare(const Method& /*method*/) {}

  /// Solves every segment. The result of a segment depends on its own data and the method only, bit
  /// for bit: not on its neighbours or its place in the batch. Throws ShapeError naming row and
  /// column if the data holds infinity, or NaN that the method does not accept, ArgumentError for
  /// parameters out of range and for priors it does not take, Cancelled.
  virtual Solution solve(const Problem& problem, const Method& method,
                         const Monitor& monitor = {}) = 0;
};

}  // namespace moclean
