#pragma once

#include <vector>

#include "moclean/linalg/memory_layout.hpp"
#include "moclean/methods/robust_pca/robust_pca.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::opencl {

/// Scalars of one segment's iteration; mirrors state_t of kernels/robust_pca/state.cl.
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

/// What an iteration reports of a block of rows; mirrors report_t of kernels/robust_pca/state.cl.
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

/// Everything one batch needs in device memory, allocated once, before the first iteration; but for
/// `observed`, which only segments with missing samples take.
/// T holds what is kept between iterations (kernels/robust_pca/entry.cl), E in the end. V, which is
/// left where the eigenproblem was, and G, the Gram matrix of the next X, change places after every
/// iteration.
template <class Real>
struct RobustPcaMemory {
  /// `sweep_rows` as in Tuning. Zero is what no launch writes: segments of norm zero, rows of Z
  /// that are not wanted, and the padding of square matrices.
  RobustPcaMemory(MemoryLayout& of, const RobustPca& method, int sweep_rows)
      : ea(method.order == UpdateOrder::ea),
        D(of.stacked<Real>()),
        T(of.stacked<Real>(Initially::zero)),
        X(of.stacked<Real>()),
        A(of.stacked<Real>(Initially::zero)),
        E(of.stacked<Real>(Initially::zero, ea)),
        rotated(of.stacked<Real>(Initially::zero, ea)),
        scratch(of.chunks<Real>(2 * sweep_rows, Initially::zero)),
        widened(of.chunks(mixed ? sweep_rows : 0)),
        W_real(of.square<Real>(Initially::zero, mixed)),
        V_real(of.square<Real>(Initially::zero, mixed)),
        Z_real(of.square<Real>(Initially::zero, mixed)),
        f_real(of.vector<Real>(Initially::zero, mixed)),
        V(of.square(Initially::zero)),
        G(of.square(Initially::zero)),
        Z(of.square(Initially::zero)),
        W(of.square(Initially::zero)),
        partial_grams(of.partial_grams(Initially::zero)),
        eigenvalues(of.vector(Initially::zero)),
        f(of.vector()),
        dual(of.vector()),
        reports(of.per_block<BlockReport>()),
        frobenius(of.per_segment()),
        largest(of.per_segment()),
        decompose(of.per_segment<std::int32_t>(Initially::zero)),
        wanted(of.per_segment<std::int32_t>()),
        terms(of.per_segment<std::int32_t>()),
        states(of.per_segment<SegmentState>(Initially::zero)),
        host_states(states.size()) {}

  static constexpr bool mixed = number_type<Real> == NumberType::float32;

  /// Where B = XZ' of the graded Gram matrix goes: order ae writes A only afterwards.
  Buffer<Real>& rotation_target() { return ea ? rotated : A; }

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
  std::vector<SegmentState> host_states;
  double keep_below = 0;  // residual from which on iterations store A
  // Whether the active segments have missing entries, of which `observed` tells: X and A are then
  // formed as wholes, and D is filled with A.
  bool missing = false;
  Buffer<Real> observed;
};

}  // namespace moclean::opencl
