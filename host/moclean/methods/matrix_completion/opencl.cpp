// Notation as in methods/matrix_completion/matrix_completion.hpp, for all active segments of a
// batch at once; G = Y'Y (YY' for wide segments), Z its eigenvectors in rows, f_k = max(1 -
// tau/sigma_k, 0), W = Z' diag(f) Z and X = YW (WY).
#include "moclean/methods/matrix_completion/opencl.hpp"

#include <algorithm>
#include <cmath>

#include "moclean/core/error.hpp"
#include "moclean/device/kernel_source.hpp"
#include "moclean/solve/opencl/stacked_rows.hpp"

namespace moclean::opencl {
namespace {

constexpr Index stacked_matrices = 4, square_matrices = 3, vectors = 2;

}  // namespace

// What one batch needs, on the device and beside it.
struct MatrixCompletionSolver::Run {
  Run(const Device& device, const SegmentBatch& data, Index first, Index last,
      const MatrixCompletion& method)
      : batch(device, data, first, last),
        D(device, batch.stacked_size()),
        observed(device, batch.stacked_size()),
        Y(device, batch.stacked_size()),
        X(device, batch.stacked_size()),
        G(device, batch.square_size()),
        Z(device, batch.square_size()),
        W(device, batch.square_size()),
        eigenvalues(device, batch.vector_size()),
        f(device, batch.vector_size()),
        deltas(device, static_cast<std::size_t>(batch.segments())),
        partial_squares(device, batch.block_count()),
        terms(device, static_cast<std::size_t>(batch.segments())),
        host_eigenvalues(batch.vector_size()),
        host_f(batch.vector_size(), 0),
        host_squares(batch.block_count()),
        host_terms(static_cast<std::size_t>(batch.segments()), 1),
        outcomes(static_cast<std::size_t>(batch.segments())) {
    // What no launch writes stays defined: padding, rows of Z that are not wanted.
    for (auto* buffer : {&X, &G, &Z, &W, &eigenvalues}) buffer->fill_zero();
    for (Index b = first; b < last; ++b)
      starts.push_back(start_completion(data.segment(b), method));
  }

  double sigma(const SegmentRecord& segment, int k) const {
    return std::sqrt(std::max(host_eigenvalues[static_cast<std::size_t>(segment.vector + k)], 0.0));
  }

  Batch batch;
  Buffer<double> D, observed, Y, X, G, Z, W, eigenvalues, f, deltas, partial_squares;
  Buffer<std::int32_t> terms;
  std::vector<double> host_eigenvalues, host_f, host_squares;
  std::vector<std::int32_t> host_terms;
  std::vector<SegmentOutcome> outcomes;
  std::vector<CompletionStart> starts;
};

MatrixCompletionSolver::MatrixCompletionSolver(const Device& device, const Tuning& tuning)
    : device_(device),
      products_(device, (moclean::check(tuning), tuning)),
      eigen_(device, tuning),
      program_(device, kernel_source::completion, common_defines(device)),
      update_(program_, "update_completion") {}

std::uint64_t MatrixCompletionSolver::memory_of(Index rows, Index columns,
                                                const MatrixCompletion&) const {
  const Index order = std::min(rows, columns);
  const Index blocks = (rows + block_rows - 1) / block_rows;
  const Index doubles = stacked_matrices * rows * padded(columns) +
                        square_matrices * order * padded(order) + vectors * padded(order) + blocks;
  return static_cast<std::uint64_t>(doubles) * sizeof(double) + eigen_.memory_of(order) +
         sizeof(SegmentRecord) + 2 * sizeof(double) +
         static_cast<std::uint64_t>(blocks) * sizeof(BlockRecord);
}

// D and the observed entries, and Y = ceil(tau / (delta |P(D)|_2)) delta P(D).
void MatrixCompletionSolver::start(Run& run) {
  std::vector<Index> first_rows = {0};
  std::vector<double> deltas;
  std::vector<std::int32_t> active;
  for (Index b = 0; b < run.batch.segments(); ++b) {
    const CompletionStart& start = run.starts[static_cast<std::size_t>(b)];
    first_rows.push_back(first_rows.back() + start.data.rows());
    deltas.push_back(start.delta);
    if (start.norm > 0) active.push_back(static_cast<std::int32_t>(b));
  }
  run.deltas.write(deltas);
  SegmentBatch values(run.starts.front().data.cols(), first_rows);
  const auto upload = [&](const auto& value_of, Buffer<double>& target) {
    for (Index b = 0; b < run.batch.segments(); ++b) values.segment(b) = value_of(b);
    target.write(values.storage());
  };
  const auto start_of = [&](Index b) -> const CompletionStart& {
    return run.starts[static_cast<std::size_t>(b)];
  };
  upload([&](Index b) -> const Matrix& { return start_of(b).observed; }, run.observed);
  upload([&](Index b) -> const Matrix& { return start_of(b).data; }, run.D);

  run.batch.select(active);
  products_.gram(run.batch, run.D, run.G);
  eigen_.all_values(run.batch, run.G, run.eigenvalues);
  run.eigenvalues.read(run.host_eigenvalues);
  upload(
      [&](Index b) -> Matrix {
        const double norm_2 = run.sigma(run.batch.segment(b), 0);
        return norm_2 > 0 ? start_of(b).kick(norm_2) * start_of(b).data : start_of(b).data;
      },
      run.Y);
}

// X = U max(sigma - tau, 0) V'
void MatrixCompletionSolver::threshold(Run& run) {
  products_.gram(run.batch, run.Y, run.G);
  eigen_.all_values(run.batch, run.G, run.eigenvalues);
  run.eigenvalues.read(run.host_eigenvalues);
  for (const std::int32_t b : run.batch.active()) {
    const auto i = static_cast<std::size_t>(b);
    const SegmentRecord& segment = run.batch.segment(b);
    int rank = 0;
    for (int k = 0; k < segment.order; ++k) {
      const double sigma = run.sigma(segment, k), tau = run.starts[i].tau;
      rank += sigma > tau;
      run.host_f[static_cast<std::size_t>(segment.vector + k)] = sigma > tau ? 1 - tau / sigma : 0;
    }
    run.outcomes[i].rank = rank;
    run.host_terms[i] = std::max(1, rank);
  }
  run.f.write(run.host_f);
  run.terms.write(run.host_terms);
  eigen_.vectors(run.batch, run.terms, run.G, run.Z);
  products_.reconstruct(run.batch, run.Z, run.f, run.terms, run.W);
  products_.apply(run.batch, run.Y, run.W, run.X);
}

// Y = Y + delta P(D - X); segments that have converged leave the batch.
void MatrixCompletionSolver::update(Run& run, const MatrixCompletion& method,
                                    const Finished& finished) {
  update_(per_block(run.batch), run.batch.device_segments(), run.batch.device_blocks(),
          run.batch.active_blocks(), run.D, run.observed, run.deltas, run.X, run.Y,
          run.partial_squares);
  run.partial_squares.read(run.host_squares);
  std::vector<std::int32_t> remaining;
  for (const std::int32_t b : run.batch.active()) {
    const auto i = static_cast<std::size_t>(b);
    const SegmentRecord& segment = run.batch.segment(b);
    const int blocks = (segment.rows + block_rows - 1) / block_rows;
    double squares = 0;
    for (int block = 0; block < blocks; ++block)
      squares += run.host_squares[static_cast<std::size_t>(segment.first_block + block)];
    SegmentOutcome& outcome = run.outcomes[i];
    ++outcome.iterations;
    outcome.residual = std::sqrt(squares) / run.starts[i].norm;
    outcome.converged = outcome.residual <= method.tolerance;
    if (!outcome.converged && outcome.iterations < method.max_iterations) remaining.push_back(b);
  }
  const auto done = run.batch.active_count() - static_cast<std::int32_t>(remaining.size());
  if (done == 0) return;
  run.batch.select(remaining);
  finished(done);
}

void MatrixCompletionSolver::solve(const Problem& problem, Index first, Index last,
                                   const MatrixCompletion& method, Solution& solution,
                                   const Finished& finished, const std::stop_token& stop) {
  Run run(device_, problem.data, first, last, method);
  start(run);
  const Index trivial = run.batch.segments() - run.batch.active_count();
  if (trivial > 0) finished(trivial);
  while (run.batch.active_count() > 0) {
    if (stop.stop_requested()) {
      device_.finish();
      throw Cancelled();
    }
    threshold(run);
    update(run, method, finished);
  }
  eigen_.check(run.batch);
  run.X.read(stacked_rows(solution.low_rank, first, last));
  for (Index b = first; b < last; ++b) {
    const auto i = static_cast<std::size_t>(b - first);
    const CompletionStart& started = run.starts[i];
    if (started.norm == 0) run.outcomes[i].converged = true;
    solution.sparse.segment(b) =
        started.observed.cwiseProduct(started.data - solution.low_rank.segment(b));
    solution.segments[static_cast<std::size_t>(b)] = run.outcomes[i];
  }
}

}  // namespace moclean::opencl
