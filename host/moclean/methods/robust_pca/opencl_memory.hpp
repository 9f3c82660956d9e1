#pragma once

#include <algorithm>
#include <vector>

#include "moclean/linalg/batch.hpp"
#include "moclean/methods/robust_pca/robust_pca.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::opencl {

/// Scalars of one segment's iteration; mirrors state_t of kernels/state.cl.
struct SegmentState {
  double mu = 0;
  double mu_next = 0;
  double inverse_last = 0;
  double mu_max = 0;
  double lambda = 0;
  double dual_scale = 0;
  double residual = 0;
  std::int32_t iterations = 0;
  std::int32_t rank = 0;
  std::int32_t converged = 0;
  std::int32_t finished = 0;
  std::int32_t order_ea = 0;
  std::int32_t pure = 0;
  std::int32_t keep = 0;
  std::int32_t low_rank = 0;
};
static_assert(sizeof(SegmentState) == 88);

/// What an iteration reports of a block of rows; mirrors report_t of kernels/state.cl.
struct BlockReport {
  double squares = 0;       ///< |D - A - E|_F^2
  std::int32_t sparse = 0;  ///< whether E is not zero; order ae only
};
static_assert(sizeof(BlockReport) == 16);

inline SegmentOutcome outcome_of(const SegmentState& state) {
  // A segment of norm zero was never started: no iteration, and solved.
  return {.iterations = state.iterations,
          .rank = state.rank,
          .residual = state.residual,
          .converged = state.converged != 0 || state.iterations == 0};
}

/// Everything one batch needs in device memory; allocated once, before the first iteration.
/// T holds what is kept between iterations (kernels/entry.cl), E in the end. V, which is left where
/// the eigenproblem was, and G, the Gram matrix of the next X, change places after every iteration.
template <class Real>
struct RobustPcaMemory {
  /// `sweep_rows` as in Tuning.
  RobustPcaMemory(const Device& device, const Batch& batch, const RobustPca& method, int sweep_rows)
      : ea(method.order == UpdateOrder::ea),
        D(device, batch.stacked_size()),
        T(device, batch.stacked_size()),
        X(device, batch.stacked_size()),
        A(device, batch.stacked_size()),
        E(device, ea ? batch.stacked_size() : 1),
        rotated(device, E.size()),
        scratch(device, 2 * chunk_size(batch, sweep_rows)),
        widened(device, mixed ? chunk_size(batch, sweep_rows) : 1),
        W_real(device, mixed ? batch.square_size() : 1),
        V_real(device, W_real.size()),
        Z_real(device, W_real.size()),
        f_real(device, mixed ? batch.vector_size() : 1),
        V(device, batch.square_size()),
        G(device, batch.square_size()),
        Z(device, batch.square_size()),
        W(device, batch.square_size()),
        partial_grams(device, std::max<std::size_t>(batch.partial_size(), 1)),
        eigenvalues(device, batch.vector_size()),
        f(device, batch.vector_size()),
        dual(device, batch.vector_size()),
        reports(device, batch.block_count()),
        frobenius(device, static_cast<std::size_t>(batch.segments())),
        largest(device, static_cast<std::size_t>(batch.segments())),
        decompose(device, static_cast<std::size_t>(batch.segments())),
        wanted(device, static_cast<std::size_t>(batch.segments())),
        terms(device, static_cast<std::size_t>(batch.segments())),
        states(device, static_cast<std::size_t>(batch.segments())) {
    // What no launch writes stays defined: segments of norm zero, rows of Z that are not wanted,
    // and the padding of square matrices.
    for (auto* buffer : {&V, &G, &Z, &W, &partial_grams, &eigenvalues}) buffer->fill_zero();
    for (auto* buffer : {&T, &A, &E, &rotated, &scratch}) buffer->fill_zero();
    for (auto* buffer : {&W_real, &V_real, &Z_real, &f_real}) buffer->fill_zero();
    decompose.fill_zero();
    states.fill_zero();
    host_states.resize(states.size());
  }

  static constexpr bool mixed = number_type<Real> == NumberType::float32;

  /// Where B = XZ' of the graded Gram matrix goes: order ae writes A only afterwards.
  Buffer<Real>& rotation_target() { return ea ? rotated : A; }

  /// Rows that the blocks of a batch work on at a time.
  static std::size_t chunk_size(const Batch& batch, int sweep_rows) {
    return batch.block_count() * static_cast<std::size_t>(sweep_rows * batch.pitch());
  }

  bool ea;
  Buffer<Real> D, T, X, A, E, rotated, scratch;
  Buffer<double> widened;                       // rows of X as doubles, mixed only
  Buffer<Real> W_real, V_real, Z_real, f_real;  // W, V, Z, f in single precision, mixed only
  Buffer<double> V, G, Z, W, partial_grams;
  Buffer<double> eigenvalues, f, dual;
  Buffer<BlockReport> reports;
  Buffer<double> frobenius, largest;
  Buffer<std::int32_t> decompose, wanted, terms;
  Buffer<SegmentState> states;
  double tau = 0;         // (1/mu) / |D|_2, the same for all segments
  double keep_below = 0;  // residual from which on iterations store A
  int iteration = 0;      // of all segments that have not finished
  // Whether the active segments have missing entries, of which `observed` tells: X and A are then
  // formed as wholes, and D is filled with A.
  bool missing = false;
  Buffer<Real> observed;
  std::vector<SegmentState> host_states;
};

}  // namespace moclean::opencl
