// Notation as in solve/reference/robust_pca.cpp, here for all active segments of a batch at once:
//   D, A, E, X, Y   stacked matrices; X is what singular value thresholding is applied to
//   G = X'X         Gram matrix (XX' where rows < columns), eigenvalues sigma^2, eigenvectors Z
//   f, W            f_k = max(1 - (1/mu)/sigma_k, 0), W = Z' diag(f) Z, so that SVT_{1/mu}(X) = XW
//   B = XZ'         X in the eigenvectors of the previous iteration: its Gram matrix is graded
#include "moclean/solve/opencl/robust_pca.hpp"

#include <algorithm>

#include "moclean/device/kernel_source.hpp"

namespace moclean::opencl {
namespace {

/// Squaring X costs half of the digits of its small singular values: sigma is known to about
/// 1e-15 |X|_2^2 / sigma. Once 1/mu has fallen below this share of |D|_2 the eigenproblem is solved
/// for B instead, whose columns have about the size of the singular values, so that each is known
/// to relative accuracy. 1/mu relative to |D|_2 is the same for all segments, so all change over in
/// the same iteration, whatever their data and neighbours.
constexpr double graded_below = 1e-5;

std::span<const double> rows_of(const SegmentBatch& batch, Index first, Index last) {
  const auto pitch = static_cast<std::size_t>(batch.pitch());
  const auto begin = static_cast<std::size_t>(batch.first_row(first)) * pitch;
  const auto end = static_cast<std::size_t>(batch.first_row(last)) * pitch;
  return batch.storage().subspan(begin, end - begin);
}

std::span<double> rows_of(SegmentBatch& batch, Index first, Index last) {
  const auto rows = rows_of(std::as_const(batch), first, last);
  return batch.storage().subspan(static_cast<std::size_t>(rows.data() - batch.storage().data()),
                                 rows.size());
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

/// Active segments that need another iteration, into `remaining` (room is kept from call to call).
void collect_unfinished(const Batch& batch, std::span<const SegmentState> states,
                        int max_iterations, std::vector<std::int32_t>& remaining) {
  remaining.clear();
  for (const std::int32_t b : batch.active()) {
    const SegmentState& state = states[static_cast<std::size_t>(b)];
    if (!state.converged && state.iterations < max_iterations) remaining.push_back(b);
  }
}

SegmentOutcome outcome_of(const SegmentState& state) {
  // A segment of norm zero was never started: no iteration, and solved.
  return {.iterations = state.iterations,
          .rank = state.rank,
          .residual = state.residual,
          .converged = state.converged != 0 || state.iterations == 0};
}

}  // namespace

/// Everything one batch needs in device memory; allocated once, before the first iteration.
struct RobustPcaSolver::Memory {
  Memory(const Device& device, const Batch& batch)
      : D(device, batch.stacked_size()),
        A(device, batch.stacked_size()),
        E(device, batch.stacked_size()),
        X(device, batch.stacked_size()),
        Y(device, batch.stacked_size()),
        G(device, batch.square_size()),
        Z(device, batch.square_size()),
        W(device, batch.square_size()),
        eigenvalues(device, batch.vector_size()),
        f(device, batch.vector_size()),
        partial_squares(device, batch.block_count()),
        frobenius(device, static_cast<std::size_t>(batch.segments())),
        largest(device, static_cast<std::size_t>(batch.segments())),
        states(device, static_cast<std::size_t>(batch.segments())) {
    // What no launch writes stays defined: segments of norm zero, and the padding of square
    // matrices.
    for (auto* buffer : {&A, &E, &G, &Z, &W}) buffer->fill_zero();
    states.fill_zero();
  }

  Buffer<double> D, A, E, X, Y;
  Buffer<double> G, Z, W;
  Buffer<double> eigenvalues, f;
  Buffer<double> partial_squares, frobenius, largest;
  Buffer<SegmentState> states;
};

RobustPcaSolver::RobustPcaSolver(const Device& device, ProductPath products)
    : device_(device),
      products_(products, device),
      eigen_(device),
      norms_(device),
      program_(device, kernel_source::robust_pca, common_defines(device)),
      start_state_(program_, "start_state"),
      start_(program_, "start"),
      threshold_(program_, "threshold"),
      shrink_(program_, "shrink"),
      advance_(program_, "advance") {}

std::uint64_t RobustPcaSolver::memory_of(Index rows, Index columns) {
  const Index order = std::min(rows, columns);
  const Index stacked = 5 * rows * padded(columns);  // D A E X Y
  const Index square = 5 * order * padded(order);    // G Z W, work of eigensolver and products
  const Index vectors = 7 * padded(order);           // eigenvalues, f, five of the eigensolver
  const Index blocks = 3 * (rows / block_rows + 1);  // partial sums
  const auto bookkeeping = sizeof(SegmentRecord) + sizeof(SegmentState) + 4 * sizeof(double);
  return static_cast<std::uint64_t>(stacked + square + vectors + blocks) * sizeof(double) +
         bookkeeping + static_cast<std::uint64_t>(blocks) * sizeof(BlockRecord);
}

// Y = D / max(|D|_2, max|D_ij| / lambda), mu = mu0_factor / |D|_2, E = 0, A = 0, and the first X;
// |D|_2 is the root of the largest eigenvalue of D'D.
void RobustPcaSolver::start(const Batch& batch, Memory& m, const RobustPca& method) {
  products_.gram(batch, m.D, m.G);
  eigen_(batch, m.G, m.Z, m.eigenvalues);
  start_state_(per_segment(batch), batch.device_segments(), batch.device_active(),
               batch.active_count(), m.eigenvalues, m.largest, method.lambda, method.lambda_scale,
               method.mu0_factor, method.mu_max_factor, method.rho,
               cl_int{method.order == UpdateOrder::ea}, m.states);
  start_(per_block(batch), batch.device_segments(), batch.device_blocks(), batch.active_blocks(),
         m.states, m.D, m.Y, m.E, m.X);
}

// sigma^2 and the eigenvectors Z of X'X; tau is (1/mu) / |D|_2.
void RobustPcaSolver::decompose(const Batch& batch, Memory& m, double tau) {
  if (tau >= graded_below) {
    products_.gram(batch, m.X, m.G);
    eigen_(batch, m.G, m.Z, m.eigenvalues);
    return;
  }
  Buffer<double>&B = m.A, &P = m.W;  // both free until the iteration writes them
  products_.rotate(batch, m.X, m.Z, B);
  products_.gram(batch, B, m.G);
  eigen_(batch, m.G, P, m.eigenvalues);
  products_.compose(batch, P, m.Z, m.G);
  std::swap(m.Z, m.G);
}

void RobustPcaSolver::iterate(const Batch& batch, Memory& m, const RobustPca& method, double tau) {
  // A = SVT_{1/mu}(X)
  decompose(batch, m, tau);
  threshold_(per_segment(batch), batch.device_segments(), batch.device_active(),
             batch.active_count(), m.eigenvalues, m.states, m.f);
  products_.reconstruct(batch, m.Z, m.f, m.W);
  products_.apply(batch, m.X, m.W, m.A);
  // E = soft(D - A + Y/mu, lambda/mu), Y = Y + mu (D - A - E), and the next X
  shrink_(per_block(batch), batch.device_segments(), batch.device_blocks(), batch.active_blocks(),
          m.states, m.D, m.A, m.Y, m.E, m.X, m.partial_squares);
  // residual = |D - A - E|_F / |D|_F, mu = min(rho mu, mu_max)
  advance_(per_segment(batch), batch.device_segments(), batch.device_active(), batch.active_count(),
           m.partial_squares, m.frobenius, method.rho, method.tolerance, m.states);
}

void RobustPcaSolver::solve(const SegmentBatch& data, Index first, Index last,
                            const RobustPca& method, Solution& solution, const Finished& finished,
                            const std::stop_token& stop) {
  Batch batch(device_, data, first, last);
  Memory m(device_, batch);
  m.D.write(rows_of(data, first, last));
  const auto drop_all_but = [&](const std::vector<std::int32_t>& kept) {
    const auto dropped = batch.active().size() - kept.size();
    if (dropped == 0) return;
    batch.select(kept);
    finished(static_cast<Index>(dropped));
  };

  norms_(batch, m.D, m.frobenius, m.largest);
  drop_all_but(nonzero_segments(batch, m.frobenius));
  start(batch, m, method);
  std::vector<SegmentState> states(static_cast<std::size_t>(batch.segments()));
  std::vector<std::int32_t> remaining;
  remaining.reserve(states.size());
  double tau = 1 / method.mu0_factor;
  while (batch.active_count() > 0) {
    if (stop.stop_requested()) {
      device_.finish();
      throw Cancelled();
    }
    iterate(batch, m, method, tau);
    tau = std::max(tau / method.rho, 1 / (method.mu0_factor * method.mu_max_factor));
    m.states.read(states);
    collect_unfinished(batch, states, method.max_iterations, remaining);
    drop_all_but(remaining);
  }
  eigen_.check(batch);

  m.A.read(rows_of(solution.low_rank, first, last));
  m.E.read(rows_of(solution.sparse, first, last));
  m.states.read(states);
  for (Index b = first; b < last; ++b)
    solution.segments[static_cast<std::size_t>(b)] =
        outcome_of(states[static_cast<std::size_t>(b - first)]);
}

}  // namespace moclean::opencl
