// Notation as in methods/matrix_normal/window.hpp and kernels/matrix_normal/conjugate_gradients.cl:
// Q = A'A, Z its eigenvectors in rows, R = Z' diag(f) Z about Q^-1, W weights over variances.
#include "moclean/methods/matrix_normal/opencl.hpp"

#include <algorithm>
#include <utility>

#include "moclean/core/error.hpp"
#include "moclean/core/parallel.hpp"
#include "moclean/methods/matrix_normal/window.hpp"

namespace moclean::opencl {
namespace {

// A window shorter than it is wide is extended until it is square.
Index extended_rows(Index rows, Index columns) { return std::max(rows, columns); }

SegmentBatch extended_shape(const SegmentBatch& data, Index first, Index last) {
  std::vector<Index> first_rows = {0};
  for (Index b = first; b < last; ++b)
    first_rows.push_back(first_rows.back() + extended_rows(data.rows(b), data.columns()));
  return {data.columns(), std::move(first_rows)};
}

}  // namespace

struct MatrixNormalSolver::Memory {
  // What no launch writes stays defined: padding, and the entries of windows not active.
  Memory(MemoryLayout& of, const ConjugateGradients& method)
      : gradients(method.memory(of)),
        Q(of.square(Initially::zero)),
        Z(of.square(Initially::zero)),
        eigenvalues(of.vector(Initially::zero)),
        f(of.vector()),
        terms(of.per_segment<std::int32_t>()) {}

  ConjugateGradients::Memory gradients;
  Buffer<double> Q, Z, eigenvalues, f;
  Buffer<std::int32_t> terms;
};

// What one batch needs, on the device and beside it. What is computed per window, is by `jobs`
// threads.
struct MatrixNormalSolver::Run {
  Run(const Device& device, const ConjugateGradients& conjugate_gradients, const Problem& problem,
      Index first, Index last, const MatrixNormal& method, int threads)
      : jobs(threads),
        host(extended_shape(problem.data, first, last)),
        motion(host.columns(), host.first_rows()),
        batch(device, host, 0, last - first),
        layout(device, batch),
        m(layout, conjugate_gradients),
        steps(windows()) {
    for_each_index(last - first, jobs, [&](Index b) {
      steps[static_cast<std::size_t>(b)].emplace(problem.data.segment(first + b), method,
                                                 problem.prior(first + b));
    });
    std::vector<std::int32_t> active;
    for (std::int32_t b = 0; b < static_cast<std::int32_t>(last - first); ++b)
      if (!window(b).trivial()) active.push_back(b);
    batch.select(active);
  }

  std::size_t windows() const { return static_cast<std::size_t>(batch.segments()); }
  MatrixNormalWindow& window(std::int32_t b) { return *steps[static_cast<std::size_t>(b)]; }

  // work(b) for every active window, several at a time.
  template <class Work>
  void for_each_active(const Work& work) const {
    const auto active = batch.active();
    for_each_index(batch.active_count(), jobs,
                   [&](Index i) { work(active[static_cast<std::size_t>(i)]); });
  }

  // Writes value_of(b) of every active window, [rows x columns].
  template <class ValueOf>
  void upload(const ValueOf& value_of, Buffer<double>& target) {
    for_each_active([&](std::int32_t b) { host.segment(b) = value_of(b); });
    target.write(host.storage());
  }

  // Writes value_of(b), [columns], of every active window.
  template <class ValueOf>
  void upload_vector(const ValueOf& value_of, Buffer<double>& target) {
    std::vector<double> values(batch.vector_size(), 0);
    for_each_active([&](std::int32_t b) { vector_of(values, b) = value_of(b); });
    target.write(values);
  }

  // Writes the precisions of the accelerations of every active window.
  void set_precisions() {
    std::vector<double> values(static_cast<std::size_t>(host.rows()), 0);
    for (const std::int32_t b : batch.active())
      Eigen::Map<Eigen::VectorXd>(values.data() + batch.segment(b).first_row, window(b).rows()) =
          window(b).precision();
    m.gradients.precisions.write(values);
  }

  // Writes the diagonal of R, and what keeps the preconditioner definite.
  template <class ValueOf>
  void set_stiffness(const ValueOf& value_of) {
    std::vector<double> shares(windows(), 0);
    for (const std::int32_t b : batch.active())
      shares[static_cast<std::size_t>(b)] = least_preconditioner_weight * value_of(b).mean();
    m.gradients.least.write(shares);
    upload_vector(value_of, m.gradients.stiffness);
  }

  Eigen::Map<Eigen::VectorXd> vector_of(std::vector<double>& values, std::int32_t b) const {
    return {values.data() + batch.segment(b).vector, batch.segment(b).order};
  }

  Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<>> diagonal_of(std::vector<double>& squares,
                                                                   std::int32_t b) const {
    const SegmentRecord& segment = batch.segment(b);
    return {squares.data() + segment.square, segment.order,
            Eigen::InnerStride<>(segment.order_pitch + 1)};
  }

  MatrixView square_of(std::vector<double>& squares, std::int32_t b) const {
    const SegmentRecord& segment = batch.segment(b);
    return {squares.data() + segment.square, segment.order, segment.order,
            Eigen::OuterStride<>(segment.order_pitch)};
  }

  int jobs;
  SegmentBatch host;    // stacked matrices on their way
  SegmentBatch motion;  // S of the step before
  Batch batch;
  MemoryLayout layout;
  Memory m;
  std::vector<std::optional<MatrixNormalWindow>> steps;
};

MatrixNormalSolver::MatrixNormalSolver(const Device& device, const Tuning& tuning, int jobs)
    : device_(device),
      jobs_(jobs),
      products_(device, (moclean::check(tuning), tuning)),
      eigen_(device, tuning),
      gradients_(device, tuning) {}

std::uint64_t MatrixNormalSolver::memory_of(Index rows, Index columns, const MatrixNormal&) const {
  const Index extended = extended_rows(rows, columns);
  return moclean::memory_of<Memory>(extended, columns, gradients_) + eigen_.memory_of(columns);
}

// A to run.m.gradients.product: accelerations of run.motion, grown where noise matters.
// Windows that need no growth are left out of it: they do not depend on others, bit for bit.
void MatrixNormalSolver::accelerate(Run& run) {
  std::vector<double> weights(run.batch.vector_size(), 0);
  std::vector<std::int32_t> growing;
  for (const std::int32_t b : run.batch.active())
    if (const auto growth = run.window(b).growth()) {
      run.vector_of(weights, b) = *growth;
      growing.push_back(b);
    }
  run.upload([&](std::int32_t b) { return run.window(b).accelerations(run.motion.segment(b)); },
             run.m.gradients.product);
  if (growing.empty()) return;
  run.m.gradients.r.write(run.host.storage());
  run.m.f.write(weights);
  const std::vector<std::int32_t> all(run.batch.active().begin(), run.batch.active().end());
  run.batch.select(growing);
  products_.reconstruct(run.batch, run.m.Z, run.m.f, run.m.terms, run.m.gradients.R);
  products_.apply(run.batch, run.m.gradients.r, run.m.gradients.R, run.m.gradients.product);
  run.batch.select(all);
}

// What is expected of Q to it, on the host.
void MatrixNormalSolver::add_prior(Run& run) {
  std::vector<double> Q(run.batch.square_size());
  run.m.Q.read(Q);
  run.for_each_active([&](std::int32_t b) { run.window(b).add_prior(run.square_of(Q, b)); });
  run.m.Q.write(Q);
}

// Q and R from run.motion.
void MatrixNormalSolver::learn(Run& run) {
  accelerate(run);
  products_.gram(run.batch, run.m.gradients.product, run.m.Q);
  add_prior(run);
  eigen_(run.batch, run.m.Q, run.m.Z, run.m.eigenvalues);
  std::vector<double> values(run.batch.vector_size());
  run.m.eigenvalues.read(values);
  run.upload_vector(
      [&](std::int32_t b) -> Eigen::VectorXd {
        return run.window(b).inverse_spectrum(run.vector_of(values, b));
      },
      run.m.f);
  products_.reconstruct(run.batch, run.m.Z, run.m.f, run.m.terms, run.m.gradients.R);
}

// S = argmin sum W (D - S)^2 + tr(P Delta S R (Delta S)') from S on, by conjugate gradients.
void MatrixNormalSolver::smooth(Run& run, const MatrixNormal& method, int step) {
  gradients_(run.batch, run.m.gradients, products_, method.solve_iterations,
             method.tolerance(step));
}

// S from the first guess, smoothed with a diagonal R.
void MatrixNormalSolver::first_smoothing(Run& run, const MatrixNormal& method) {
  std::vector<double> R(run.batch.square_size(), 0);
  std::vector<Eigen::VectorXd> diagonals(run.windows());
  run.upload(
      [&](std::int32_t b) {
        auto guess = run.window(b).first_guess();
        run.diagonal_of(R, b) = guess.stiffness;
        diagonals[static_cast<std::size_t>(b)] = std::move(guess.stiffness);
        return guess.motion;
      },
      run.m.gradients.S);
  run.m.gradients.D.write(run.host.storage());
  run.m.gradients.R.write(R);
  run.set_precisions();
  run.set_stiffness([&](std::int32_t b) { return diagonals[static_cast<std::size_t>(b)]; });
  run.upload(
      [&](std::int32_t b) {
        return Matrix::Ones(run.window(b).rows(), run.window(b).columns()).eval();
      },
      run.m.gradients.W);
  smooth(run, method, 0);
}

// Weights and targets from the residuals, on the host.
void MatrixNormalSolver::weigh(Run& run) {
  std::vector<double> R(run.batch.square_size());
  run.m.gradients.R.read(R);
  std::vector<Eigen::VectorXd> diagonals(run.windows());
  run.for_each_active([&](std::int32_t b) {
    diagonals[static_cast<std::size_t>(b)] = run.diagonal_of(R, b);
    run.window(b).weigh(run.motion.segment(b), run.square_of(R, b));
  });
  run.set_stiffness([&](std::int32_t b) { return diagonals[static_cast<std::size_t>(b)]; });
  run.set_precisions();
  run.upload([&](std::int32_t b) -> const Matrix& { return run.window(b).weights(); },
             run.m.gradients.W);
  const auto changed = [&](std::int32_t b) { return run.window(b).target_changed(); };
  if (std::ranges::any_of(run.batch.active(), changed))
    run.upload([&](std::int32_t b) -> const Matrix& { return run.window(b).target(); },
               run.m.gradients.D);
}

void MatrixNormalSolver::solve(const Problem& problem, Index first, Index last,
                               const MatrixNormal& method, Solution& solution,
                               const Finished& finished, const std::stop_token& stop) {
  Run run(device_, gradients_, problem, first, last, method, jobs_);
  if (run.batch.active_count() > 0) {
    run.m.terms.write(std::vector<std::int32_t>(run.windows(),
                                                static_cast<std::int32_t>(problem.data.columns())));
    first_smoothing(run, method);
    run.m.gradients.iterations.fill_zero();
    run.m.gradients.S.read(run.motion.storage());
  }
  const int steps = method.soft_steps + method.hard_steps;
  for (int step = 0; step < steps && run.batch.active_count() > 0; ++step) {
    if (stop.stop_requested()) {
      device_.finish();
      throw Cancelled();
    }
    learn(run);
    weigh(run);
    smooth(run, method, step);
    run.m.gradients.S.read(
        run.motion.storage());  // for the noise, and for the next step to learn from
    run.for_each_active(
        [&](std::int32_t b) { run.window(b).estimate_noise(run.motion.segment(b)); });
  }
  if (run.batch.active_count() > 0) eigen_.check(run.batch);
  finish(run, first, solution);
  finished(last - first);
}

void MatrixNormalSolver::finish(Run& run, Index first, Solution& solution) {
  std::vector<std::int32_t> iterations(run.windows());
  run.m.gradients.iterations.read(iterations);
  std::vector<double> Z(run.batch.square_size());
  run.m.Z.read(Z);
  for_each_index(run.batch.segments(), jobs_, [&](Index i) {
    const Index b = first + i;
    const auto place = static_cast<std::int32_t>(i);
    const MatrixNormalWindow& window = run.window(place);
    const auto own = run.motion.segment(i);
    solution.low_rank.segment(b) = window.trivial() ? window.filled() : window.cleaned(own);
    solution.trusted->segment(b) = window.trusted().cast<double>();
    solution.deviation->segment(b) = window.deviation(own, run.square_of(Z, place));
    solution.sparse.segment(b) = window.rejected(solution.low_rank.segment(b));
    solution.segments[static_cast<std::size_t>(b)] = {
        .iterations = iterations[static_cast<std::size_t>(i)],
        .rank = {},
        .residual = 0,
        .converged = false,
        .fixed_steps = true};
  });
}

}  // namespace moclean::opencl
