#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "moclean/linalg/norms.hpp"
#include "moclean/methods/robust_pca/opencl_entry_steps.hpp"
#include "moclean/methods/robust_pca/opencl_spectrum.hpp"
#include "moclean/methods/robust_pca/robust_pca.hpp"
#include "moclean/solve/problem.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::opencl {

/// Robust PCA of many segments at once on a device; the steps are those of
/// methods/robust_pca/reference.cpp, in the same order. The stacked matrices are of type Real: with
/// float, Gram matrix and eigenproblem are double all the same, and a tolerance of 1e-6 is reached.
template <class Real>
class RobustPcaSolver {
 public:
  /// Throws ArgumentError for a tuning out of its range.
  RobustPcaSolver(const Device& device, const Tuning& tuning);

  /// Bytes of device memory a segment of this size takes.
  std::uint64_t memory_of(Index rows, Index columns, const RobustPca& method) const;

  /// Called with the number of segments that finished since the last call.
  using Finished = std::function<void(Index)>;

  /// Solves the segments [first, last) of `problem` into the same segments of `solution`.
  void solve(const Problem& problem, Index first, Index last, const RobustPca& method,
             Solution& solution, const Finished& finished, const std::stop_token& stop);

 private:
  using Memory = RobustPcaMemory<Real>;

  std::vector<std::int32_t> load(const SegmentBatch& data, Index first, Index last,
                                 const Batch& batch, Memory& m);
  void solve_active(Batch& batch, Memory& m, const RobustPca& method, const Finished& finished,
                    const std::stop_token& stop);
  std::vector<std::int32_t> run(Batch& batch, Memory& m, const RobustPca& method,
                                const Finished& finished, const std::stop_token& stop);
  void start(const Batch& batch, Memory& m, const RobustPca& method, const Iteration& first);
  void iterate(const Batch& batch, Memory& m, const RobustPca& method, const Iteration& now);
  std::vector<std::int32_t> retire(Batch& batch, Memory& m, bool swept, const Finished& finished);
  double least_residual(const Batch& batch, const Memory& m) const;

  const Device& device_;
  int sweep_rows_;
  Program steps_;
  Kernel start_state_, advance_;  // of steps_
  Norms<Real> norms_;
  RobustPcaSpectrum<Real> spectrum_;
  EntrySteps<Real> entries_;
};

}  // namespace moclean::opencl
