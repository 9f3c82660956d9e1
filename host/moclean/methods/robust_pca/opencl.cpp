// Notation as in methods/robust_pca/reference.cpp, here for all active segments of a batch at once:
//   D, A, E, X, Y   stacked matrices; X is what singular value thresholding is applied to; X+ and
//                   Y+ are those of the next iteration
//   T               mu (D - A) + Y, which tells Y+ and E; order ea: Y (kernels/robust_pca/entry.cl)
//   G = X'X         Gram matrix (XX' where rows < columns), eigenvalues sigma^2, eigenvectors Z
//   f, W            f_k = max(1 - (1/mu)/sigma_k, 0), W = Z' diag(f) Z, so that SVT_{1/mu}(X) = XW
//   V               Z' for the vectors with f_k > 0
//   B = XZ'         X in the eigenvectors of the previous iteration: its Gram matrix is graded
#include "moclean/methods/robust_pca/opencl.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "moclean/core/error.hpp"
#include "moclean/device/kernel_source.hpp"
#include "moclean/solve/missing.hpp"
#include "moclean/solve/opencl/transfer.hpp"

namespace moclean::opencl {
namespace {

/// Active segments whose norm is not zero; the others are solved by A = E = 0.
std::vector<std::int32_t> nonzero_segments(const Batch& batch, const Buffer<double>& frobenius) {
  std::vector<double> norms(static_cast<std::size_t>(batch.segments()));
  frobenius.read(norms);
  std::vector<std::int32_t> remaining;
  for (const std::int32_t b : batch.active())
    if (norms[static_cast<std::size_t>(b)] > 0) remaining.push_back(b);
  return remaining;
}

}  // namespace

template <class Real>
RobustPcaSolver<Real>::RobustPcaSolver(const Device& device, const Tuning& tuning)
    : device_(device),
      sweep_rows_((check(tuning), tuning.sweep_rows)),
      steps_(device, kernel_source::robust_pca, common_defines(device)),
      start_state_(steps_, "start_state"),
      advance_(steps_, "advance"),
      norms_(device, tuning),
      spectrum_(device, tuning, steps_),
      entries_(device, tuning) {}

template <class Real>
std::uint64_t RobustPcaSolver<Real>::memory_of(Index rows, Index columns,
                                               const RobustPca& method) const {
  return moclean::memory_of<Memory>(rows, columns, method, sweep_rows_) +
         spectrum_.memory_of(std::min(rows, columns));
}

// Y = D / max(|D|_2, max|D_ij| / lambda), mu = mu0_factor / |D|_2, E = 0, A = 0; |D|_2 is the root
// of the largest eigenvalue of D'D.
template <class Real>
void RobustPcaSolver<Real>::start(const Batch& batch, Memory& m, const RobustPca& method,
                                  const Iteration& first) {
  spectrum_.of_data(batch, m, first);
  const bool pure = !m.ea && !first.graded() && !m.missing;  // X has the singular vectors of D
  start_state_(per_segment(batch), batch.device_segments(), batch.device_active(),
               batch.active_count(), m.eigenvalues, m.largest, method.lambda, method.lambda_scale,
               method.mu0_factor, method.mu_max_factor, method.rho, cl_int{m.ea}, cl_int{pure},
               method.max_iterations, m.keep_below, m.states, m.dual, m.decompose);
  entries_.start(batch, m);
}

template <class Real>
void RobustPcaSolver<Real>::iterate(const Batch& batch, Memory& m, const RobustPca& method,
                                    const Iteration& now) {
  // X = D - E + Y/mu, order ea with E = soft(D - A + Y/mu, lambda/mu); else the sweep forms it
  if (now.whole_x() || batch.has_wide())
    entries_.form(batch, m, now.whole_x() ? GramOf::all : GramOf::wide);
  // X = U sigma V'
  spectrum_.of_shifted(batch, m, now);
  // A = SVT_{1/mu}(X) = XW, order ae: E = soft(D - A + Y/mu, lambda/mu), Y+ = Y + mu (D - A - E)
  if (now.swept()) {
    const bool with_gram = now.update == Iteration::Update::sweep_with_gram;
    entries_.sweep(batch, m, spectrum_.multiplier(batch, m, now), with_gram);
    if (with_gram) spectrum_.add_up(batch, m);
  } else {
    spectrum_.apply(batch, m);
    entries_.shrink(batch, m);
  }
  // residual = |D - A - E|_F / |D|_F, mu = min(rho mu, mu_max)
  advance_(per_segment(batch), batch.device_segments(), batch.device_active(), batch.active_count(),
           m.reports, m.frobenius, method.rho, method.tolerance, cl_int{method.max_iterations},
           m.keep_below, cl_int{!now.before_graded()}, m.states, m.decompose, m.wanted);
  std::swap(m.V, m.G);
}

// Segments that have finished since the last call leave the batch; the others are its active
// segments. Returns those that have finished in an iteration that did not keep A, as a sweep may.
template <class Real>
std::vector<std::int32_t> RobustPcaSolver<Real>::retire(Batch& batch, Memory& m, bool swept,
                                                        const Finished& finished) {
  m.states.read(m.host_states);
  std::vector<std::int32_t> remaining, lost;
  Index done = 0;
  for (const std::int32_t b : batch.active()) {
    const SegmentState& state = m.host_states[static_cast<std::size_t>(b)];
    if (!state.finished)
      remaining.push_back(b);
    else if (state.keep || !swept)
      ++done;
    else
      lost.push_back(b);
  }
  if (remaining.size() == batch.active().size()) return lost;
  batch.select(remaining);
  if (done > 0) finished(done);
  return lost;
}

// Of the active segments, as they were read last.
template <class Real>
double RobustPcaSolver<Real>::least_residual(const Batch& batch, const Memory& m) const {
  double least = 1;
  for (const std::int32_t b : batch.active())
    least = std::min(least, m.host_states[static_cast<std::size_t>(b)].residual);
  return least;
}

// Iterates from the start until all active segments have finished; returns those of which A was
// not kept.
template <class Real>
std::vector<std::int32_t> RobustPcaSolver<Real>::run(Batch& batch, Memory& m,
                                                     const RobustPca& method,
                                                     const Finished& finished,
                                                     const std::stop_token& stop) {
  std::vector<std::int32_t> lost;
  const IterationSetting setting = spectrum_.setting(m);
  Iteration now = first_iteration(method, setting);
  start(batch, m, method, now);
  while (batch.active_count() > 0) {
    for (int i = iterations_until_look(now, least_residual(batch, m), method); i > 0; --i) {
      if (stop.stop_requested()) {
        device_.finish();
        throw Cancelled();
      }
      iterate(batch, m, method, now);
      now = next_iteration(now, method, setting);
      if (now.graded()) break;
    }
    const auto more = retire(batch, m, now.swept(), finished);
    lost.insert(lost.end(), more.begin(), more.end());
  }
  std::ranges::sort(lost);
  return lost;
}

// D, 0 where it is missing, and its norms; returns the segments that have missing entries. Their
// gaps are filled once the norms are known.
template <class Real>
std::vector<std::int32_t> RobustPcaSolver<Real>::load(const SegmentBatch& data, Index first,
                                                      Index last, const Batch& batch, Memory& m) {
  std::vector<std::int32_t> incomplete;
  for (Index b = first; b < last; ++b)
    if (has_missing(data.segment(b))) incomplete.push_back(static_cast<std::int32_t>(b - first));
  if (incomplete.empty()) {
    upload(stacked_rows(data, first, last), m.D);
    norms_(batch, m.D, m.frobenius, m.largest);
    return incomplete;
  }
  if (Memory::mixed) throw ArgumentError("missing samples need double precision (f64)");
  upload(data, first, last, incomplete, observed_part, m.D);
  norms_(batch, m.D, m.frobenius, m.largest);
  upload(data, first, last, incomplete, filled_along_time, m.D);
  m.observed = Buffer<Real>(device_, batch.stacked_size());
  upload(data, first, last, incomplete, observed_entries, m.observed);
  return incomplete;
}

// Solves these segments, all of which have missing entries or none.
template <class Real>
void RobustPcaSolver<Real>::solve_active(Batch& batch, Memory& m, const RobustPca& method,
                                         const Finished& finished, const std::stop_token& stop) {
  const auto remaining = nonzero_segments(batch, m.frobenius);
  if (remaining.size() < batch.active().size()) {
    finished(static_cast<Index>(batch.active().size() - remaining.size()));
    batch.select(remaining);
  }
  m.keep_below = 2 * steepest_fall(method) * method.tolerance;
  const auto lost = run(batch, m, method, finished, stop);
  if (lost.empty()) return;
  m.keep_below = std::numeric_limits<double>::infinity();
  batch.select(lost);
  run(batch, m, method, finished, stop);
}

template <class Real>
void RobustPcaSolver<Real>::solve(const Problem& problem, Index first, Index last,
                                  const RobustPca& method, Solution& solution,
                                  const Finished& finished, const std::stop_token& stop) {
  Batch batch(device_, problem.data, first, last);
  MemoryLayout layout(device_, batch);
  Memory m(layout, method, sweep_rows_);
  const std::vector<std::int32_t> all(batch.active().begin(), batch.active().end());
  const std::vector<std::int32_t> incomplete = load(problem.data, first, last, batch, m);
  std::vector<std::int32_t> complete;
  std::ranges::set_difference(all, incomplete, std::back_inserter(complete));
  if (!incomplete.empty()) batch.select(complete);
  solve_active(batch, m, method, finished, stop);
  if (!incomplete.empty()) {
    m.missing = true;
    batch.select(incomplete);
    solve_active(batch, m, method, finished, stop);
  }
  batch.select(all);
  entries_.finish(batch, m);
  spectrum_.check(batch);

  download(m.A, stacked_rows(solution.low_rank, first, last));
  download(m.T, stacked_rows(solution.sparse, first, last));
  m.states.read(m.host_states);
  for (Index b = first; b < last; ++b)
    solution.segments[static_cast<std::size_t>(b)] =
        outcome_of(m.host_states[static_cast<std::size_t>(b - first)]);
}

template class RobustPcaSolver<double>;
template class RobustPcaSolver<float>;

}  // namespace moclean::opencl
