#pragma once

#include <functional>
#include <stop_token>

#include "moclean/linalg/eigensolver.hpp"
#include "moclean/linalg/products.hpp"
#include "moclean/methods/matrix_normal/matrix_normal.hpp"
#include "moclean/methods/matrix_normal/opencl_conjugate_gradients.hpp"
#include "moclean/solve/problem.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::opencl {

/// Matrix-normal smoothing of many windows at once on a device, in double; the steps are those of
/// methods/matrix_normal/reference.cpp, in the same order. The device does what grows with the cube
/// of the columns or with frames times columns squared, and the conjugate gradients as a whole; the
/// host computes the statistics of MatrixNormalWindow between two steps.
class MatrixNormalSolver {
 public:
  /// Up to `jobs` threads compute the statistics of windows; the result does not depend on them.
  /// Throws ArgumentError for a tuning out of its range.
  MatrixNormalSolver(const Device& device, const Tuning& tuning, int jobs = 1);

  using Finished = std::function<void(Index)>;

  /// Bytes of device memory a window of this size takes.
  std::uint64_t memory_of(Index rows, Index columns, const MatrixNormal& method) const;

  /// Solves the segments [first, last) of `problem` into the same segments of `solution`.
  void solve(const Problem& problem, Index first, Index last, const MatrixNormal& method,
             Solution& solution, const Finished& finished, const std::stop_token& stop);

 private:
  struct Memory;
  struct Run;

  void first_smoothing(Run& run, const MatrixNormal& method);
  void accelerate(Run& run);
  void add_prior(Run& run);
  void learn(Run& run);
  void weigh(Run& run);
  void smooth(Run& run, const MatrixNormal& method, int step);
  void finish(Run& run, Index first, Solution& solution);

  const Device& device_;
  int jobs_;
  Products<double> products_;
  Eigensolver eigen_;
  ConjugateGradients gradients_;
};

}  // namespace moclean::opencl
