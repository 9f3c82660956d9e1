// Notation as in methods/temporal_robust_pca/temporal_robust_pca.hpp, for all active segments of a
// batch at once;
//   X         right-hand side of the band systems for S, then S - U/mu
//   G = X'X   (XX' for wide segments), Z its eigenvectors in rows, f_k = max(1 - nu/(mu sigma_k),
//   0),
//             W = Z' diag(f) Z and L = XW (WX)
#include "moclean/methods/temporal_robust_pca/opencl.hpp"

#include <algorithm>
#include <cmath>

#include "moclean/core/error.hpp"
#include "moclean/core/parallel.hpp"
#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work_group.hpp"
#include "moclean/solve/opencl/stacked_rows.hpp"

namespace moclean::opencl {
namespace {

constexpr int difference = 2;
constexpr Index stacked_matrices = 8, square_matrices = 3, vectors = 2, scalars = 5;

}  // namespace

// What one batch needs, on the device and beside it.
struct TemporalRobustPcaSolver::Run {
  Run(const Device& device, const Banded<double>& banded, const SegmentBatch& data, Index first,
      Index last, const TemporalRobustPca& method, int jobs)
      : batch(device, data, first, last),
        D(device, batch.stacked_size()),
        P(device, batch.stacked_size()),
        S(device, batch.stacked_size()),
        L(device, batch.stacked_size()),
        E(device, batch.stacked_size()),
        Y(device, batch.stacked_size()),
        U(device, batch.stacked_size()),
        X(device, batch.stacked_size()),
        G(device, batch.square_size()),
        Z(device, batch.square_size()),
        W(device, batch.square_size()),
        eigenvalues(device, batch.vector_size()),
        f(device, batch.vector_size()),
        mus(device, segments()),
        next_mus(device, segments()),
        weights(device, segments()),
        penalties(device, segments()),
        lambdas(device, segments()),
        partial_gaps(device, batch.block_count()),
        partial_splits(device, batch.block_count()),
        terms(device, segments()),
        bands(banded.shared_bands(batch)),
        host_eigenvalues(batch.vector_size()),
        host_f(batch.vector_size(), 0),
        gaps(batch.block_count()),
        splits(batch.block_count()),
        mu(segments(), 1),
        mu_max(segments(), 1),
        host_terms(segments(), 1),
        outcomes(segments()) {
    // What no launch writes stays defined: segments of norm zero, rows of Z that are not wanted.
    for (auto* buffer : {&S, &L, &E, &Y, &U, &G, &Z, &W, &eigenvalues}) buffer->fill_zero();
    starts.resize(segments());
    for_each_index(last - first, jobs, [&](Index b) {
      starts[static_cast<std::size_t>(b)] = start_temporal(data.segment(first + b), method);
    });
  }

  std::size_t segments() const { return static_cast<std::size_t>(batch.segments()); }

  double sigma(const SegmentRecord& segment, int k) const {
    return std::sqrt(std::max(host_eigenvalues[static_cast<std::size_t>(segment.vector + k)], 0.0));
  }

  Batch batch;
  Buffer<double> D, P, S, L, E, Y, U, X, G, Z, W, eigenvalues, f;
  Buffer<double> mus, next_mus, weights, penalties, lambdas, partial_gaps, partial_splits;
  Buffer<std::int32_t> terms;
  SharedBands<double> bands;
  std::vector<double> host_eigenvalues, host_f, gaps, splits, mu, mu_max;
  std::vector<std::int32_t> host_terms;
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
    : device_(device),
      jobs_(jobs),
      products_(device, (moclean::check(tuning), tuning)),
      eigen_(device, tuning),
      banded_(device, difference) {
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
  const Index order = std::min(rows, columns);
  const Index blocks = (rows + block_rows - 1) / block_rows;
  const Index doubles = stacked_matrices * rows * padded(columns) + (difference + 1) * rows +
                        square_matrices * order * padded(order) + vectors * padded(order) +
                        2 * blocks + scalars;
  return static_cast<std::uint64_t>(doubles) * sizeof(double) + eigen_.memory_of(order) +
         sizeof(SegmentRecord) + 2 * sizeof(double) +
         static_cast<std::uint64_t>(blocks) * sizeof(BlockRecord);
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
  run.penalties.write(penalties);
  run.lambdas.write(lambdas);
  SegmentBatch values(run.starts.front().data.cols(), first_rows);
  const auto upload = [&](const auto& value_of, Buffer<double>& target) {
    for_each_index(values.segments(), jobs_,
                   [&](Index b) { values.segment(b) = value_of(static_cast<std::size_t>(b)); });
    target.write(values.storage());
  };
  upload([&](std::size_t b) -> const Matrix& { return run.starts[b].observed; }, run.P);
  upload([&](std::size_t b) -> const Matrix& { return run.starts[b].data; }, run.D);

  run.batch.select(active);
  products_.gram(run.batch, run.D, run.G);
  eigen_.all_values(run.batch, run.G, run.eigenvalues);
  run.eigenvalues.read(run.host_eigenvalues);
  for (const std::int32_t b : active) {
    const auto i = static_cast<std::size_t>(b);
    run.mu[i] = method.mu0_factor / run.sigma(run.batch.segment(b), 0);
    run.mu_max[i] = method.mu_max_factor * run.mu[i];
  }
  upload([&](std::size_t b) -> Matrix { return 2 * run.mu[b] * run.starts[b].data; }, run.X);
}

// (gamma Delta'Delta + 2 mu I) S = mu (D - E) + Y + mu L + U, whose right-hand side is in X
void TemporalRobustPcaSolver::update_smooth(Run& run) {
  std::vector<double> weights = run.mu;
  for (double& weight : weights) weight *= 2;
  run.weights.write(weights);
  banded_.factor(run.batch, run.weights, run.penalties, run.bands);
  banded_.solve(run.batch, run.bands, run.X, run.S);
}

// L = SVT_{nu/mu}(S - U/mu)
void TemporalRobustPcaSolver::update_low_rank(Run& run, const TemporalRobustPca& method) {
  run.mus.write(run.mu);
  programs().shift(grid(run.batch), run.batch.device_segments(), run.batch.device_blocks(),
                   run.batch.active_blocks(), run.mus, run.S, run.U, run.X);
  products_.gram(run.batch, run.X, run.G);
  eigen_.all_values(run.batch, run.G, run.eigenvalues);
  run.eigenvalues.read(run.host_eigenvalues);
  for (const std::int32_t b : run.batch.active()) {
    const auto i = static_cast<std::size_t>(b);
    const SegmentRecord& segment = run.batch.segment(b);
    const double tau = method.nu / run.mu[i];
    int rank = 0;
    for (int k = 0; k < segment.order; ++k) {
      const double sigma = run.sigma(segment, k);
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
  products_.apply(run.batch, run.X, run.W, run.L);
}

// T = D - S + Y/mu, Y+ = clamp(mu T, -Lambda, Lambda), E = T - Y+/mu, U = U + mu (L - S),
// mu = min(rho mu, mu_max)
void TemporalRobustPcaSolver::update_sparse(Run& run, const TemporalRobustPca& method) {
  for (const std::int32_t b : run.batch.active()) {
    const auto i = static_cast<std::size_t>(b);
    run.mu[i] = std::min(method.rho * run.mu[i], run.mu_max[i]);
  }
  run.next_mus.write(run.mu);
  programs().update(grid(run.batch), run.batch.device_segments(), run.batch.device_blocks(),
                    run.batch.active_blocks(), run.mus, run.next_mus, run.lambdas, run.D, run.P,
                    run.S, run.L, run.E, run.Y, run.U, run.X, run.partial_gaps, run.partial_splits);
}

// Segments that have converged or are out of iterations leave the batch; returns how many.
Index TemporalRobustPcaSolver::retire(Run& run, const TemporalRobustPca& method) {
  run.partial_gaps.read(run.gaps);
  run.partial_splits.read(run.splits);
  std::vector<std::int32_t> remaining;
  for (const std::int32_t b : run.batch.active()) {
    const auto i = static_cast<std::size_t>(b);
    const SegmentRecord& segment = run.batch.segment(b);
    const int blocks = (segment.rows + block_rows - 1) / block_rows;
    double gap = 0, split = 0;
    for (int block = 0; block < blocks; ++block) {
      gap += run.gaps[static_cast<std::size_t>(segment.first_block + block)];
      split += run.splits[static_cast<std::size_t>(segment.first_block + block)];
    }
    SegmentOutcome& outcome = run.outcomes[i];
    ++outcome.iterations;
    outcome.residual = std::sqrt(std::max(gap, split)) / run.starts[i].norm;
    outcome.converged = outcome.residual <= method.tolerance;
    if (!outcome.converged && outcome.iterations < method.max_iterations) remaining.push_back(b);
  }
  const auto done = run.batch.active_count() - static_cast<std::int32_t>(remaining.size());
  if (done > 0) run.batch.select(remaining);
  return done;
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
    if (const Index done = retire(run, method); done > 0) finished(done);
  }
  eigen_.check(run.batch);
  run.S.read(stacked_rows(solution.low_rank, first, last));
  run.E.read(stacked_rows(solution.sparse, first, last));
  for (Index b = first; b < last; ++b) {
    const auto i = static_cast<std::size_t>(b - first);
    if (run.starts[i].norm == 0) run.outcomes[i].converged = true;
    solution.segments[static_cast<std::size_t>(b)] = run.outcomes[i];
  }
}

}  // namespace moclean::opencl
