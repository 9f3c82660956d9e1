#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string_view>

#include "moclean/linalg/banded.hpp"
#include "moclean/methods/temporal_robust_pca/temporal_robust_pca.hpp"
#include "moclean/solve/opencl/soft_threshold.hpp"
#include "moclean/solve/problem.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::opencl {

/// Robust PCA with a second-difference penalty of many segments at once on a device, in double; the
/// steps are those of methods/temporal_robust_pca/reference.cpp, in the same order. The host looks
/// at the singular values of every iteration and asks for the vectors of those above nu/mu only.
/// Steps over entries are taken by a work-item per block of rows
/// (kernels/temporal_robust_pca/temporal.cl), or with KernelForm::gpu by a work-group
/// (kernels/temporal_robust_pca/temporal_group.cl).
class TemporalRobustPcaSolver {
 public:
  /// Throws ArgumentError for a tuning out of its range.
  TemporalRobustPcaSolver(const Device& device, const Tuning& tuning, int jobs = 1);

  using Finished = std::function<void(Index)>;

  /// Bytes of device memory a segment of this size takes.
  std::uint64_t memory_of(Index rows, Index columns, const TemporalRobustPca& method) const;

  /// Solves the segments [first, last) of `problem` into the same segments of `solution`.
  void solve(const Problem& problem, Index first, Index last, const TemporalRobustPca& method,
             Solution& solution, const Finished& finished, const std::stop_token& stop);

 private:
  struct Memory;
  struct Run;

  struct Programs {
    Programs(const Device& device, std::string_view source, const Defines& defines);
    std::size_t largest_group() const;

    Program program;
    Kernel shift, update;
  };
  struct GroupPrograms : Programs {
    GroupPrograms(const Device& device, int work_group);
  };

  Programs& programs() { return in_groups_ ? *in_groups_ : *in_vectors_; }
  Grid grid(const Batch& batch) const;
  void start(Run& run, const TemporalRobustPca& method);
  void update_smooth(Run& run);
  void update_low_rank(Run& run, const TemporalRobustPca& method);
  void update_sparse(Run& run, const TemporalRobustPca& method);
  Index end_iteration(Run& run, const TemporalRobustPca& method);

  const Device& device_;
  int jobs_;
  SoftThreshold threshold_;
  Banded<double> banded_;
  int work_group_ = 1;
  std::optional<Programs> in_vectors_;
  std::optional<GroupPrograms> in_groups_;
};

}  // namespace moclean::opencl
