#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "moclean/linalg/eigensolver.hpp"
#include "moclean/linalg/norms.hpp"
#include "moclean/linalg/products.hpp"
#include "moclean/methods/robust_pca/opencl_entry_steps.hpp"
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
  static constexpr bool mixed = Memory::mixed;

  // Of kernels/robust_pca/grams.cl: what a sweep leaves to be summed, and mixed precision.
  struct GramKernels {
    GramKernels(const Device& device, const Tuning& tuning);

    Program program;
    Kernel sum, of_floats, of_wide_floats, narrow;
  };

  // Where the Gram matrix of an iteration is from.
  enum class GramSource {
    last_sweep,     // the sweep of the iteration before, which formed X by rows; wide segments: X
    whole_matrix,   // X as a whole
    single_floats,  // X in single precision, by rows
    rotated         // B, X as a whole in the eigenvectors of the iteration before
  };

  static bool graded(double tau);
  GramSource gram_source(const Memory& m) const;
  bool swept(const Memory& m) const;
  std::vector<std::int32_t> load(const SegmentBatch& data, Index first, Index last,
                                 const Batch& batch, Memory& m);
  void solve_active(Batch& batch, Memory& m, const RobustPca& method, const Finished& finished,
                    const std::stop_token& stop);
  void start(const Batch& batch, Memory& m, const RobustPca& method);
  void prepare(const Batch& batch, Memory& m);
  void gram_of_data(const Batch& batch, Memory& m);
  void gram_of_floats(const Batch& batch, Memory& m, const Buffer<Real>& wide, bool shifted);
  void sum_partial_grams(const Batch& batch, Memory& m, Buffer<double>& g);
  void decompose(const Batch& batch, Memory& m, const RobustPca& method);
  void threshold(const Batch& batch, Memory& m, bool low_rank_permitted);
  void sweep(const Batch& batch, Memory& m, bool with_gram);
  void apply_and_shrink(const Batch& batch, Memory& m);
  void iterate(const Batch& batch, Memory& m, const RobustPca& method);
  std::vector<std::int32_t> retire(Batch& batch, Memory& m, const Finished& finished);
  std::vector<std::int32_t> run(Batch& batch, Memory& m, const RobustPca& method,
                                const Finished& finished, const std::stop_token& stop);
  int iterations_until_next_look(const Batch& batch, const Memory& m,
                                 const RobustPca& method) const;

  const Device& device_;
  int sweep_rows_;
  Products<double> products_;
  Eigensolver eigen_;
  Norms<Real> norms_;
  EntrySteps<Real> entries_;
  std::optional<GramKernels> grams_;  // where an iteration is one sweep
  Program steps_;
  Kernel start_state_, threshold_, advance_;  // of steps_
};

}  // namespace moclean::opencl
