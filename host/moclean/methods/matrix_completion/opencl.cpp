// Notation as in matrix_completion.hpp, for all active segments of a batch at once.
#include "moclean/methods/matrix_completion/opencl.hpp"

#include <cmath>

#include "moclean/core/error.hpp"
#include "moclean/device/kernel_source.hpp"
#include "moclean/solve/opencl/iteration.hpp"
#include "moclean/solve/opencl/stacked_rows.hpp"

namespace moclean::opencl {

struct MatrixCompletionSolver::Memory {
  explicit Memory(MemoryLayout& of)
      : D(of.stacked()),
        observed(of.stacked()),
        Y(of.stacked()),
        X(of.stacked(Initially::zero)),
        deltas(of.per_segment()),
        partial_squares(of.per_block()),
        spectrum(of) {}

  Buffer<double> D, observed, Y, X, deltas, partial_squares;
  SoftThreshold::Memory spectrum;
};

// What one batch needs, on the device and beside it.
struct MatrixCompletionSolver::Run {
  Run(const Device& device, const SegmentBatch& data, Index first, Index last,
      const MatrixCompletion& method)
      : batch(device, data, first, last),
        layout(device, batch),
        m(layout),
        squares(batch.block_count()),
        outcomes(static_cast<std::size_t>(batch.segments())) {
    for (Index b = first; b < last; ++b) {
      starts.push_back(start_completion(data.segment(b), method));
      taus.push_back(starts.back().tau);
    }
  }

  Batch batch;
  MemoryLayout layout;
  Memory m;
  std::vector<double> squares, taus, deltas;
  std::vector<SegmentOutcome> outcomes;
  std::vector<CompletionStart> starts;
};

MatrixCompletionSolver::MatrixCompletionSolver(const Device& device, const Tuning& tuning)
    : device_(device),
      threshold_(device, tuning),
      program_(device, kernel_source::completion, common_defines(device)),
      update_(program_, "update_completion") {}

std::uint64_t MatrixCompletionSolver::memory_of(Index rows, Index columns,
                                                const MatrixCompletion&) const {
  return moclean::memory_of<Memory>(rows, columns) + threshold_.scratch_of(rows, columns);
}

// D and the observed entries, and Y = ceil(tau / (delta |P(D)|_2)) delta P(D).
void MatrixCompletionSolver::start(Run& run) {
  std::vector<Index> first_rows = {0};
  std::vector<std::int32_t> active;
  for (std::size_t b = 0; b < run.starts.size(); ++b) {
    const CompletionStart& start = run.starts[b];
    first_rows.push_back(first_rows.back() + start.data.rows());
    run.deltas.push_back(start.delta);
    if (start.norm > 0) active.push_back(static_cast<std::int32_t>(b));
  }
  run.m.deltas.write(run.deltas);
  SegmentBatch host(run.starts.front().data.cols(), first_rows);
  const auto& starts = run.starts;
  upload(
      host, [&](std::size_t b) -> const Matrix& { return starts[b].observed; }, run.m.observed);
  upload(
      host, [&](std::size_t b) -> const Matrix& { return starts[b].data; }, run.m.D);

  run.batch.select(active);
  const std::vector<double> norms = threshold_.spectral_norms(run.batch, run.m.D, run.m.spectrum);
  const auto kicked = [&](std::size_t b) -> Matrix {
    return norms[b] > 0 ? starts[b].kick(norms[b]) * starts[b].data : starts[b].data;
  };
  upload(host, kicked, run.m.Y);
}

// Y = Y + delta P(D - X), and what delta is next; segments that have converged leave the batch.
void MatrixCompletionSolver::update(Run& run, const MatrixCompletion& method,
                                    const Finished& finished) {
  Memory& m = run.m;
  update_(per_block(run.batch), run.batch.device_segments(), run.batch.device_blocks(),
          run.batch.active_blocks(), m.D, m.observed, m.deltas, m.X, m.Y, m.partial_squares);
  m.partial_squares.read(run.squares);
  std::vector<double> residuals(run.starts.size(), 0);
  bool shorter = false;
  for (const std::int32_t b : run.batch.active()) {
    const auto i = static_cast<std::size_t>(b);
    residuals[i] = std::sqrt(sum_of_blocks(run.batch.segment(b), run.squares)) / run.starts[i].norm;
    const SegmentOutcome& outcome = run.outcomes[i];
    const double before = outcome.iterations == 0 ? 1 : outcome.residual,
                 delta = next_step(run.deltas[i], residuals[i], before);
    shorter |= delta < run.deltas[i];
    run.deltas[i] = delta;
  }
  if (shorter) m.deltas.write(run.deltas);
  const Index done =
      retire(run.batch, residuals, method.tolerance, method.max_iterations, run.outcomes);
  if (done > 0) finished(done);
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
    threshold_(run.batch, run.m.Y, run.taus, run.m.spectrum, run.outcomes, run.m.X);
    update(run, method, finished);
  }
  threshold_.check(run.batch);
  run.m.X.read(stacked_rows(solution.low_rank, first, last));
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
