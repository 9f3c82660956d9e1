#pragma once

#include <functional>
#include <stop_token>

#include "moclean/methods/matrix_completion/matrix_completion.hpp"
#include "moclean/solve/opencl/soft_threshold.hpp"
#include "moclean/solve/problem.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::opencl {

/// Low-rank completion of many segments at once on a device, in double; the steps are those of
/// methods/matrix_completion/reference.cpp, in the same order.
class MatrixCompletionSolver {
 public:
  /// Throws ArgumentError for a tuning out of its range.
  MatrixCompletionSolver(const Device& device, const Tuning& tuning);

  using Finished = std::function<void(Index)>;

  /// Bytes of device memory a segment of this size takes.
  std::uint64_t memory_of(Index rows, Index columns, const MatrixCompletion& method) const;

  /// Solves the segments [first, last) of `problem` into the same segments of `solution`.
  void solve(const Problem& problem, Index first, Index last, const MatrixCompletion& method,
             Solution& solution, const Finished& finished, const std::stop_token& stop);

 private:
  struct Memory;
  struct Run;

  void start(Run& run);
  void update(Run& run, const MatrixCompletion& method, const Finished& finished);

  const Device& device_;
  SoftThreshold threshold_;
  Program program_;
  Kernel update_;
};

}  // namespace moclean::opencl
