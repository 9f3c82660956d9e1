#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "moclean/core/segment_batch.hpp"
#include "moclean/solve/matrix_completion.hpp"
#include "moclean/solve/matrix_normal.hpp"
#include "moclean/solve/problem.hpp"
#include "moclean/solve/robust_pca.hpp"
#include "moclean/solve/singular_value_thresholding.hpp"
#include "moclean/solve/temporal_robust_pca.hpp"
#include "moclean/solve/truncated_svd.hpp"

namespace moclean {

/// What is computed. A method missing on one backend does not compile (std::visit).
using Method = std::variant<RobustPca, TruncatedSvd, SingularValueThresholding, MatrixCompletion,
                            TemporalRobustPca, MatrixNormal>;

/// Whether a method takes NaN as "not observed"; the others need every sample.
bool accepts_missing(const Method& method);

/// Whether a method uses what is known beside the samples.
bool takes_prior(const Method& method);

/// Whether a method tells which samples it used, and how far it may be off.
bool tells_trust(const Method& method);

/// How the solution of one segment came about.
struct SegmentOutcome {
  int iterations = 0;
  /// Singular values above the last threshold: of A, of L for tslra, of X for completion. Nothing
  /// where the method has none.
  std::optional<int> rank = 0;
  /// After the last iteration, over the observed entries: |D - A - E|_F / |D|_F of robust PCA, of
  /// tslra the larger of it and |L - S|_F / |D|_F, |D - A|_F / |D|_F of completion; 0 for a zero
  /// segment, and for methods of one step, which are exact.
  double residual = 0;
  bool converged = false;  ///< the residual has come down to the tolerance
  /// The method takes a fixed number of steps, whatever they achieve: it has no residual, and does
  /// not claim to have converged. Its iterations are those of its linear solver, in all steps.
  bool fixed_steps = false;
};

/// Whether an iteration to a tolerance ended before it got there.
inline bool fell_short(const SegmentOutcome& outcome) {
  return !outcome.converged && !outcome.fixed_steps;
}

/// D = low_rank + sparse, segment by segment, in the layout of the data; where D is NaN, sparse is
/// 0. Matrix-normal smoothing takes noise away besides, which is in neither.
struct Solution {
  SegmentBatch low_rank;  ///< A
  SegmentBatch sparse;    ///< E
  std::vector<SegmentOutcome> segments;
  // Of methods that tell, see tells_trust():
  std::optional<SegmentBatch> trusted = {};    ///< 1 where a sample was used, else 0
  std::optional<SegmentBatch> deviation = {};  ///< standard deviation of the motion
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
/// infinite or larger than `largest_entry`.
void require_finite(const SegmentBatch& data);

/// The same, but lets NaN pass if the method accepts it; throws ArgumentError for priors that the
/// method does not take, or that are not one per segment. Every backend calls it before it computes
/// anything.
void require_usable(const Problem& problem, const Method& method);

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
