// Notation as in temporal_robust_pca.hpp, for all active segments of a batch at once; X is the
// right-hand side of the band systems for S, then S - U/mu.
#include "moclean/methods/temporal_robust_pca/opencl.hpp"

#include <algorithm>
#include <cmath>

#include "moclean/core/error.hpp"
#include "moclean/core/parallel.hpp"
#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work_group.hpp"
#include "moclean/solve/opencl/iteration.hpp"
#include "moclean/solve/opencl/stacked_rows.hpp"

namespace moclean::opencl {
namespace {

constexpr int difference = 2;

}  // namespace

struct TemporalRobustPcaSolver::Memory {
  Memory(MemoryLayout& of, const Banded<double>& banded)
      : D(of.stacked()),
        P(of.stacked()),
        S(of.stacked(Initially::zero)),
        L(of.stacked(Initially::zero)),
        E(of.stacked(Initially::zero)),
        Y(of.stacked(Initially::zero)),
        U(of.stacked(Initially::zero)),
        X(of.stacked()),
        mus(of.per_segment()),
        next_mus(of.per_segment()),
        weights(of.per_segment()),
        penalties(of.per_segment()),
        lambdas(of.per_segment()),
        partial_gaps(of.per_block()),
        partial_splits(of.per_block()),
        bands(banded.shared_bands(of)),
        spectrum(of) {}

  Buffer<double> D, P, S, L, E, Y, U, X;
  Buffer<double> mus, next_mus, weights, penalties, lambdas, partial_gaps, partial_splits;
  SharedBands<double> bands;
  SoftThreshold::Memory spectrum;
};

// What one batch needs, on the device and beside it.
struct TemporalRobustPcaSolver::Run {
  Run(const Device& device, const Banded<double>& banded, const SegmentBatch& data, Index first,
      Index last, const TemporalRobustPca& method, int jobs)
      : batch(device, data, first, last),
        layout(device, batch),
        m(layout, banded),
        gaps(batch.block_count()),
        splits(batch.block_count()),
        mu(segments(), 1),
        mu_max(segments(), 1),
        outcomes(segments()),
        starts(segments()) {
    for_each_index(last - first, jobs, [&](Index b) {
      starts[static_cast<std::size_t>(b)] = start_temporal(data.segment(first + b), method);
    });
  }

  std::size_t segments() const { return static_cast<std::size_t>(batch.segments()); }

  Batch batch;
  MemoryLayout layout;
  Memory m;
  std::vector<double> gaps, splits, mu, mu_max;
  std::vector<SegmentOutcome> outcomes;
  std::vector<TemporalStart> starts;
};

TemporalRobustPcaSolver::Programs::Programs(const Device& device, std::string_view source,
                                            const Defines& defines)
    : program(device, source, defines), shift(program, "shift"), update(program, "update") {}

std::size_t TemporalRobustPcaSolver::Programs::largest_group() const {
  return std::min(shift.largest_group(), update.largest_group());
}

TemporalRobustPcaSolver::GroupPrograms::GroupPrograms(const Device& device, int work_group)
    : Programs(device, kernel_source::temporal_group, group_defines(device, work_group)) {}

TemporalRobustPcaSolver::TemporalRobustPcaSolver(const Device& device, const Tuning& tuning,
                                                 int jobs)
    : device_(device), jobs_(jobs), threshold_(device, tuning), banded_(device, difference) {
  if (tuning.form == KernelForm::gpu)
    work_group_ = fit_work_group(in_groups_, device, tuning.work_group);
  else
    in_vectors_.emplace(device, kernel_source::temporal, common_defines(device));
}

Grid TemporalRobustPcaSolver::grid(const Batch& batch) const {
  return in_groups_ ? group_per_block(batch, work_group_) : per_block(batch);
}

std::uint64_t TemporalRobustPcaSolver::memory_of(Index rows, Index columns,
                                                 const TemporalRobustPca&) const {
  return moclean::memory_of<Memory>(rows, columns, banded_) + threshold_.scratch_of(rows, columns);
}

// S = L = D, E = Y = U = 0, mu = mu0_factor / |D|_2; the first right-hand side is 2 mu D.
void TemporalRobustPcaSolver::start(Run& run, const TemporalRobustPca& method) {
  std::vector<Index> first_rows = {0};
  std::vector<double> penalties, lambdas;
  std::vector<std::int32_t> active;
  for (std::size_t b = 0; b < run.segments(); ++b) {
    const TemporalStart& start = run.starts[b];
    first_rows.push_back(first_rows.back() + start.data.rows());
    penalties.push_back(start.gamma);
    lambdas.push_back(start.lambda);
    if (start.norm > 0) active.push_back(static_cast<std::int32_t>(b));
  }
  run.m.penalties.write(penalties);
  run.m.lambdas.write(lambdas);
  SegmentBatch host(run.starts.front().data.cols(), first_rows);
  const auto& starts = run.starts;
  upload(
      host, [&](std::size_t b) -> const Matrix& { return starts[b].observed; }, run.m.P, jobs_);
  upload(
      host, [&](std::size_t b) -> const Matrix& { return starts[b].data; }, run.m.D, jobs_);

  run.batch.select(active);
  const std::vector<double> norms = threshold_.spectral_norms(run.batch, run.m.D, run.m.spectrum);
  for (const std::int32_t b : active) {
    const auto i = static_cast<std::size_t>(b);
    run.mu[i] = method.mu0_factor / norms[i];
    run.mu_max[i] = method.mu_max_factor * run.mu[i];
  }
  upload(
      host, [&](std::size_t b) -> Matrix { return 2 * run.mu[b] * starts[b].data; }, run.m.X,
      jobs_);
}

// (gamma Delta'Delta + 2 mu I) S = mu (D - E) + Y + mu L + U, whose right-hand side is in X
void TemporalRobustPcaSolver::update_smooth(Run& run) {
  std::vector<double> weights = run.mu;
  for (double& weight : weights) weight *= 2;
  Memory& m = run.m;
  m.weights.write(weights);
  banded_.factor(run.batch, m.weights, m.penalties, m.bands);
  banded_.solve(run.batch, m.bands, m.X, m.S);
}

// L = SVT_{nu/mu}(S - U/mu)
void TemporalRobustPcaSolver::update_low_rank(Run& run, const TemporalRobustPca& method) {
  Memory& m = run.m;
  m.mus.write(run.mu);
  programs().shift(grid(run.batch), run.batch.device_segments(), run.batch.device_blocks(),
                   run.batch.active_blocks(), m.mus, m.S, m.U, m.X);
  std::vector<double> taus = run.mu;
  for (double& tau : taus) tau = method.nu / tau;
  threshold_(run.batch, m.X, taus, m.spectrum, run.outcomes, m.L);
}

// T = D - S + Y/mu, Y+ = clamp(mu T, -Lambda, Lambda), E = T - Y+/mu, U = U + mu (L - S),
// mu = min(rho mu, mu_max)
void TemporalRobustPcaSolver::update_sparse(Run& run, const TemporalRobustPca& method) {
  for (const std::int32_t b : run.batch.active()) {
    const auto i = static_cast<std::size_t>(b);
    run.mu[i] = std::min(method.rho * run.mu[i], run.mu_max[i]);
  }
  Memory& m = run.m;
  m.next_mus.write(run.mu);
  programs().update(grid(run.batch), run.batch.device_segments(), run.batch.device_blocks(),
                    run.batch.active_blocks(), m.mus, m.next_mus, m.lambdas, m.D, m.P, m.S, m.L,
                    m.E, m.Y, m.U, m.X, m.partial_gaps, m.partial_splits);
}

// Segments that have converged or are out of iterations leave the batch; returns how many.
Index TemporalRobustPcaSolver::end_iteration(Run& run, const TemporalRobustPca& method) {
  run.m.partial_gaps.read(run.gaps);
  run.m.partial_splits.read(run.splits);
  std::vector<double> residuals(run.segments(), 0);
  for (const std::int32_t b : run.batch.active()) {
    const SegmentRecord& segment = run.batch.segment(b);
    const double gap = sum_of_blocks(segment, run.gaps), split = sum_of_blocks(segment, run.splits);
    const auto i = static_cast<std::size_t>(b);
    residuals[i] = std::sqrt(std::max(gap, split)) / run.starts[i].norm;
  }
  return retire(run.batch, residuals, method.tolerance, method.max_iterations, run.outcomes);
}

void TemporalRobustPcaSolver::solve(const Problem& problem, Index first, Index last,
                                    const TemporalRobustPca& method, Solution& solution,
                                    const Finished& finished, const std::stop_token& stop) {
  Run run(device_, banded_, problem.data, first, last, method, jobs_);
  start(run, method);
  const Index trivial = run.batch.segments() - run.batch.active_count();
  if (trivial > 0) finished(trivial);
  while (run.batch.active_count() > 0) {
    if (stop.stop_requested()) {
      device_.finish();
      throw Cancelled();
    }
    update_smooth(run);
    update_low_rank(run, method);
    update_sparse(run, method);
    if (const Index done = end_iteration(run, method); done > 0) finished(done);
  }
  threshold_.check(run.batch);
  run.m.S.read(stacked_rows(solution.low_rank, first, last));
  run.m.E.read(stacked_rows(solution.sparse, first, last));
  for (Index b = first; b < last; ++b) {
    const auto i = static_cast<std::size_t>(b - first);
    if (run.starts[i].norm == 0) run.outcomes[i].converged = true;
    solution.segments[static_cast<std::size_t>(b)] = run.outcomes[i];
  }
}

}  // namespace moclean::opencl
