// Notation as in methods/robust_pca/reference.cpp, here for all active segments of a batch at once:
//   D, A, E, X, Y   stacked matrices; X is what singular value thresholding is applied to; X+ and
//                   Y+ are those of the next iteration
//   T               mu (D - A) + Y, which tells Y+ and E; order ea: Y (kernels/entry.cl)
//   G = X'X         Gram matrix (XX' where rows < columns), eigenvalues sigma^2, eigenvectors Z
//   f, W            f_k = max(1 - (1/mu)/sigma_k, 0), W = Z' diag(f) Z, so that SVT_{1/mu}(X) = XW
//   V               Z' for the vectors with f_k > 0
//   B = XZ'         X in the eigenvectors of the previous iteration: its Gram matrix is graded
#include "moclean/methods/robust_pca/opencl.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "moclean/core/error.hpp"
#include "moclean/device/kernel_source.hpp"
#include "moclean/methods/robust_pca/opencl_work.hpp"
#include "moclean/solve/missing.hpp"
#include "moclean/solve/opencl/transfer.hpp"

namespace moclean::opencl {
namespace {

/// Squaring X costs half of the digits of its small singular values: sigma is known to about
/// 1e-15 |X|_2^2 / sigma. Once 1/mu has fallen below this share of |D|_2 the eigenproblem is solved
/// for B instead, whose columns have about the size of the singular values, so that each is known
/// to relative accuracy. 1/mu relative to |D|_2 is the same for all segments, so all change over in
/// the same iteration, whatever their data and neighbours.
constexpr double graded_below = 6e-7;

/// How much the residual can fall in one iteration. It falls by about rho and never was seen to
/// fall by four with the default; nothing but time is lost if it does.
double steepest_fall(const RobustPca& method) { return 4 * method.rho / 1.5; }

double next_tau(double tau, const RobustPca& method) {
  return std::max(tau / method.rho, 1 / (method.mu0_factor * method.mu_max_factor));
}

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
RobustPcaSolver<Real>::GramKernels::GramKernels(const Device& device, const Tuning& tuning)
    : program(device, kernel_source::grams, sweep_defines(device, NumberType::float64, tuning)),
      sum(program, "sum_grams"),
      of_floats(program, "gram_of_floats"),
      of_wide_floats(program, "gram_of_wide_floats"),
      narrow(program, "narrow") {}

template <class Real>
RobustPcaSolver<Real>::RobustPcaSolver(const Device& device, const Tuning& tuning)
    : device_(device),
      sweep_rows_((check(tuning), tuning.sweep_rows)),
      products_(device, tuning),
      eigen_(device, tuning, mixed ? 1e-8 : 1e-12),  // far below what the iteration makes of it
      norms_(device, tuning),
      entries_(device, tuning),
      steps_(device, kernel_source::robust_pca, common_defines(device)),
      start_state_(steps_, "start_state"),
      threshold_(steps_, "threshold"),
      advance_(steps_, "advance") {
  const bool fuses = tuning.form == KernelForm::cpu && tuning.products == ProductPath::own;
  if (fuses) grams_.emplace(device, tuning);
}

template <class Real>
std::uint64_t RobustPcaSolver<Real>::memory_of(Index rows, Index columns,
                                               const RobustPca& method) const {
  const Index order = std::min(rows, columns);
  const Index blocks = (rows + block_rows - 1) / block_rows;
  const Index scratch = blocks * sweep_rows_ * padded(columns);  // of a chunk
  const Index stacked = (method.order == UpdateOrder::ea ? 6 : 4) * rows * padded(columns);
  const Index square = order * padded(order);
  const Index reals = stacked + 2 * scratch + (mixed ? 3 * square + padded(order) : 0);
  const Index doubles = (5 + (rows < columns ? 0 : blocks - 1)) * square + 3 * padded(order) +
                        (mixed ? scratch : 0) + 4 * blocks;
  const auto bookkeeping = sizeof(SegmentRecord) + sizeof(SegmentState) + 8 * sizeof(double);
  return static_cast<std::uint64_t>(reals) * sizeof(Real) +
         static_cast<std::uint64_t>(doubles) * sizeof(double) + eigen_.memory_of(order) +
         bookkeeping + static_cast<std::uint64_t>(blocks) * sizeof(BlockRecord);
}

// G = D'D (DD' for wide segments).
template <class Real>
void RobustPcaSolver<Real>::gram_of_data(const Batch& batch, Memory& m) {
  if constexpr (mixed)
    gram_of_floats(batch, m, m.D, false);
  else
    products_.gram(batch, m.D, m.V);
}

// The same for D or for X, of which `wide` has the rows of wide segments.
template <class Real>
void RobustPcaSolver<Real>::gram_of_floats(const Batch& batch, Memory& m, const Buffer<Real>& wide,
                                           bool shifted) {
  if constexpr (mixed) {
    grams_->of_floats.with([&] { return tall_gram_work(batch, sizeof(Real)); })(
        per_block(batch), batch.device_segments(), batch.device_blocks(), batch.active_blocks(),
        m.states, m.decompose, cl_int{shifted}, m.D, m.T, m.A, m.widened, m.V, m.partial_grams);
    sum_partial_grams(batch, m, m.V);
    if (batch.has_wide())
      grams_->of_wide_floats(per_row(batch), batch.device_segments(), batch.device_active(), wide,
                             m.V);
  }
}

template <class Real>
void RobustPcaSolver<Real>::sum_partial_grams(const Batch& batch, Memory& m, Buffer<double>& g) {
  if (batch.partial_size() > 0)
    grams_->sum(per_row(batch), batch.device_segments(), batch.device_active(), m.partial_grams, g);
}

// Whether an iteration is one sweep over the rows, or one matrix after the other: with products of
// CLBlast, in the GPU form, or where entries are missing.
template <class Real>
bool RobustPcaSolver<Real>::swept(const Memory& m) const {
  return grams_ && !m.missing;
}

// Single precision leaves nothing of X that grading could save.
template <class Real>
bool RobustPcaSolver<Real>::graded(double tau) {
  return !mixed && tau < graded_below;
}

// Y = D / max(|D|_2, max|D_ij| / lambda), mu = mu0_factor / |D|_2, E = 0, A = 0; |D|_2 is the root
// of the largest eigenvalue of D'D.
template <class Real>
void RobustPcaSolver<Real>::start(const Batch& batch, Memory& m, const RobustPca& method) {
  m.tau = 1 / method.mu0_factor;
  m.iteration = 0;
  gram_of_data(batch, m);
  eigen_.all_values(batch, m.V, m.eigenvalues);
  if (graded(m.tau)) eigen_.all_vectors(batch, m.V, m.Z);   // the first iteration needs a basis
  const bool pure = !m.ea && !graded(m.tau) && !m.missing;  // X has the singular vectors of D
  start_state_(per_segment(batch), batch.device_segments(), batch.device_active(),
               batch.active_count(), m.eigenvalues, m.largest, method.lambda, method.lambda_scale,
               method.mu0_factor, method.mu_max_factor, method.rho, cl_int{m.ea}, cl_int{pure},
               method.max_iterations, m.keep_below, m.states, m.dual, m.decompose);
  entries_.start(batch, m);
}

template <class Real>
typename RobustPcaSolver<Real>::GramSource RobustPcaSolver<Real>::gram_source(
    const Memory& m) const {
  if (graded(m.tau)) return GramSource::rotated;
  if (mixed) return GramSource::single_floats;
  // The first X of order ae is pure (kernels/robust_pca.cl) and takes no eigenproblem.
  const bool first = m.iteration == 0 && m.ea;
  return swept(m) && !first ? GramSource::last_sweep : GramSource::whole_matrix;
}

// X where it is needed as a whole, and its Gram matrix but for graded iterations.
template <class Real>
void RobustPcaSolver<Real>::prepare(const Batch& batch, Memory& m) {
  const GramSource source = gram_source(m);
  const bool whole = source == GramSource::whole_matrix || source == GramSource::rotated;
  if (whole || batch.has_wide()) entries_.form(batch, m, whole ? GramOf::all : GramOf::wide);
  if constexpr (mixed)
    gram_of_floats(batch, m, m.X, true);
  else if (source == GramSource::whole_matrix)
    products_.gram(batch, m.X, m.V);
  else if (source == GramSource::last_sweep && batch.has_wide())
    products_.gram(batch, m.X, m.V, GramOf::wide);
}

// sigma^2, f, and the eigenvectors of X'X, which is in V, that the threshold leaves.
template <class Real>
void RobustPcaSolver<Real>::decompose(const Batch& batch, Memory& m, const RobustPca& method) {
  if (!graded(m.tau)) {
    eigen_.values(batch, m.decompose, m.V, m.eigenvalues);
    threshold(batch, m, swept(m) && eigen_.leaves_columns());
    if (graded(next_tau(m.tau, method)))
      eigen_.all_vectors(batch, m.V, m.Z);
    else
      eigen_.vectors(batch, m.wanted, m.V, m.Z);
    return;
  }
  if constexpr (!mixed) {
    Buffer<double>&B = m.rotation_target(), &P = m.W;  // both free until the iteration writes them
    products_.rotate(batch, m.X, m.Z, B);
    products_.gram(batch, B, m.V);
    eigen_(batch, m.V, P, m.eigenvalues);
    products_.compose(batch, P, m.Z, m.V);
    std::swap(m.Z, m.V);
    threshold(batch, m, false);
  }
}

template <class Real>
void RobustPcaSolver<Real>::threshold(const Batch& batch, Memory& m, bool low_rank_permitted) {
  threshold_(per_segment(batch), batch.device_segments(), batch.device_active(),
             batch.active_count(), m.eigenvalues, cl_int{low_rank_permitted}, m.states, m.dual, m.f,
             m.wanted, m.terms);
}

// A = XW, E = soft(D - A + Y/mu, lambda/mu), Y+ = Y + mu (D - A - E), and if the next iteration
// takes it from here the Gram matrix of X+.
template <class Real>
void RobustPcaSolver<Real>::sweep(const Batch& batch, Memory& m, bool with_gram) {
  const bool low_rank = !graded(m.tau) && eigen_.leaves_columns();
  products_.reconstruct(batch, m.Z, m.f, m.terms, m.W);
  if constexpr (mixed) {
    // What the sweep multiplies by, in single precision.
    grams_->narrow(per_row(batch), batch.device_segments(), batch.device_active(), m.states, m.W,
                   m.V, m.Z, m.f, m.W_real, m.V_real, m.Z_real, m.f_real);
    entries_.sweep(batch, m, {m.W_real, m.V_real, m.Z_real, m.f_real, low_rank}, with_gram);
  } else {
    entries_.sweep(batch, m, {m.W, m.V, m.Z, m.f, low_rank}, with_gram);
    if (with_gram) sum_partial_grams(batch, m, m.G);
  }
}

// The same with A as a whole between eigenproblem and shrinkage.
template <class Real>
void RobustPcaSolver<Real>::apply_and_shrink(const Batch& batch, Memory& m) {
  if constexpr (!mixed) {
    products_.reconstruct(batch, m.Z, m.f, m.terms, m.W);
    products_.apply(batch, m.X, m.W, m.A);
    entries_.shrink(batch, m);
  }
}

template <class Real>
void RobustPcaSolver<Real>::iterate(const Batch& batch, Memory& m, const RobustPca& method) {
  const double next = next_tau(m.tau, method);
  prepare(batch, m);
  decompose(batch, m, method);
  if (swept(m))
    sweep(batch, m, !mixed && !graded(next));
  else
    apply_and_shrink(batch, m);
  // residual = |D - A - E|_F / |D|_F, mu = min(rho mu, mu_max)
  advance_(per_segment(batch), batch.device_segments(), batch.device_active(), batch.active_count(),
           m.reports, m.frobenius, method.rho, method.tolerance, cl_int{method.max_iterations},
           m.keep_below, cl_int{!graded(next)}, m.states, m.decompose, m.wanted);
  std::swap(m.V, m.G);
  m.tau = next;
  m.iteration += 1;
}

// Segments that have finished since the last call leave the batch; the others are its active
// segments. Returns those that have finished in an iteration that did not keep A.
template <class Real>
std::vector<std::int32_t> RobustPcaSolver<Real>::retire(Batch& batch, Memory& m,
                                                        const Finished& finished) {
  m.states.read(m.host_states);
  std::vector<std::int32_t> remaining, lost;
  Index done = 0;
  for (const std::int32_t b : batch.active()) {
    const SegmentState& state = m.host_states[static_cast<std::size_t>(b)];
    if (!state.finished)
      remaining.push_back(b);
    else if (state.keep || !swept(m))
      ++done;
    else
      lost.push_back(b);
  }
  if (remaining.size() == batch.active().size()) return lost;
  batch.select(remaining);
  if (done > 0) finished(done);
  return lost;
}

// Iterations that are certain not to finish a segment, going by the residuals that were read.
template <class Real>
int RobustPcaSolver<Real>::iterations_until_next_look(const Batch& batch, const Memory& m,
                                                      const RobustPca& method) const {
  // Products of whole matrices do not leave out what has finished, nor do those of a graded
  // iteration.
  if (graded(m.tau) || !swept(m)) return 1;
  if (m.iteration == 0) return 1;  // nothing has been read yet, and the first step may be large
  double least = 1;
  for (const std::int32_t b : batch.active())
    least = std::min(least, m.host_states[static_cast<std::size_t>(b)].residual);
  const double steps = std::log(least / method.tolerance) / std::log(steepest_fall(method));
  return std::clamp(static_cast<int>(steps), 1, method.max_iterations);
}

// Iterates from the start until all active segments have finished; returns those of which A was
// not kept.
template <class Real>
std::vector<std::int32_t> RobustPcaSolver<Real>::run(Batch& batch, Memory& m,
                                                     const RobustPca& method,
                                                     const Finished& finished,
                                                     const std::stop_token& stop) {
  std::vector<std::int32_t> lost;
  start(batch, m, method);
  while (batch.active_count() > 0) {
    for (int i = iterations_until_next_look(batch, m, method); i > 0; --i) {
      if (stop.stop_requested()) {
        device_.finish();
        throw Cancelled();
      }
      iterate(batch, m, method);
      if (graded(m.tau)) break;
    }
    const auto more = retire(batch, m, finished);
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
  if (mixed) throw ArgumentError("missing samples need double precision (f64)");
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
  Memory m(device_, batch, method, sweep_rows_);
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
  eigen_.check(batch);

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
