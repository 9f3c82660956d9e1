#include "moclean/backend/opencl_backend.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/methods/matrix_completion/opencl.hpp"
#include "moclean/methods/matrix_normal/opencl.hpp"
#include "moclean/methods/robust_pca/opencl.hpp"
#include "moclean/methods/spectral/opencl.hpp"
#include "moclean/methods/temporal_robust_pca/opencl.hpp"
#include "moclean/solve/missing.hpp"
#include "moclean/solve/opencl/concurrent.hpp"

namespace moclean {
namespace {

/// Queues for a method that leaves a GPU waiting for the host nine tenths of the time
/// (docs/gpu.md).
constexpr int host_bound_queues = 4;

int queues_of(const Tuning& tuning, const DeviceInfo& device, const Method& method) {
  const bool many = device.kind == DeviceKind::gpu && device.compute_units >= host_bound_queues;
  const bool waits = many && std::holds_alternative<MatrixNormal>(method);
  return waits ? std::max(tuning.queues, host_bound_queues) : tuning.queues;
}

/// Bytes of the cache that batches in flight should share; no bound on devices other than CPUs.
std::uint64_t shared_cache(const DeviceInfo& device) {
  const bool bounds = device.kind == DeviceKind::cpu && device.global_cache > 0;
  return bounds ? device.global_cache : opencl::BatchBounds::none;
}

Tuning tuning_of(const Device& device, const OpenClOptions& options) {
  Tuning tuning = options.tuning.value_or(default_tuning(device.info()));
  if (options.precision == Precision::mixed) {
    if (options.form == KernelForm::gpu)
      throw ArgumentError("mixed precision works with form cpu only, not with gpu");
    if (options.products == ProductPath::clblast)
      throw ArgumentError("mixed precision works with products own only, not with clblast");
    tuning.form = KernelForm::cpu;
    tuning.products = ProductPath::own;
  }
  tuning.form = options.form.value_or(tuning.form);
  tuning.products = options.products.value_or(tuning.products);
  return tuning;
}

}  // namespace

/// What solves one batch at a time: a queue of the device, kernels and their scratch memory.
class OpenClBackend::Worker {
 public:
  /// Uses the queue of `device` itself. `tuning` has to outlive the worker.
  Worker(const Device& device, const OpenClOptions& options, const Tuning& tuning)
      : tuning_(tuning), precision_(options.precision), jobs_(options.jobs), device_(device) {}

  /// Has a queue of its own.
  Worker(const Device& device, Device::AnotherQueue another, const OpenClOptions& options,
         const Tuning& tuning)
      : tuning_(tuning),
        precision_(options.precision),
        jobs_(options.jobs),
        own_(std::in_place, device, another),
        device_(*own_) {}

  /// Makes the solver of a method, which compiles its kernels, unless there is one.
  template <class Chosen>
  void prepare(const Chosen& method) {
    auto& solver = solver_for(method);
    if (solver) return;
    using Solver = std::remove_reference_t<decltype(*solver)>;
    if constexpr (std::is_same_v<Chosen, RobustPca>)
      solver.emplace(solver_of(device_, precision_, tuning_));
    else if constexpr (std::is_constructible_v<Solver, const Device&, const Tuning&, int>)
      solver.emplace(device_, tuning_, jobs_);
    else
      solver.emplace(device_, tuning_);
  }

  /// use(solver) with the solver of a method that is prepared.
  template <class Chosen, class Use>
  void with(const Chosen& method, const Use& use) {
    if constexpr (std::is_same_v<Chosen, RobustPca>)
      std::visit(use, *solver_for(method));
    else
      use(*solver_for(method));
  }

 private:
  using RobustPcaSolver =
      std::variant<opencl::RobustPcaSolver<double>, opencl::RobustPcaSolver<float>>;

  static RobustPcaSolver solver_of(const Device& device, Precision precision,
                                   const Tuning& tuning) {
    if (precision == Precision::mixed) return opencl::RobustPcaSolver<float>(device, tuning);
    return opencl::RobustPcaSolver<double>(device, tuning);
  }

  auto& solver_for(const RobustPca&) { return robust_pca_; }
  auto& solver_for(const MatrixCompletion&) { return completion_; }
  auto& solver_for(const TemporalRobustPca&) { return temporal_; }
  auto& solver_for(const MatrixNormal&) { return matrix_normal_; }
  auto& solver_for(const TruncatedSvd&) { return spectral_; }
  auto& solver_for(const SingularValueThresholding&) { return spectral_; }

  const Tuning& tuning_;
  Precision precision_;
  int jobs_;
  std::optional<Device> own_;
  const Device& device_;
  std::optional<RobustPcaSolver> robust_pca_;
  std::optional<opencl::SpectralSolver> spectral_;
  std::optional<opencl::MatrixCompletionSolver> completion_;
  std::optional<opencl::TemporalRobustPcaSolver> temporal_;
  std::optional<opencl::MatrixNormalSolver> matrix_normal_;
};

OpenClBackend::OpenClBackend(const Device& device, const OpenClOptions& options)
    : device_(device), options_(options), tuning_(tuning_of(device, options)) {
  moclean::check(tuning_);
  if (options_.memory_limit == 0) options_.memory_limit = device.info().usable_memory();
  workers_.push_back(std::make_unique<Worker>(device, options, tuning_));
}

OpenClBackend::~OpenClBackend() = default;

std::string OpenClBackend::name() const {
  return fmt::format("opencl ({}, form {}, products {}{})", device_.info().name,
                     to_string(tuning_.form), to_string(tuning_.products),
                     options_.precision == Precision::mixed ? ", mixed precision" : "");
}

// A GPU gives a work-group to every segment; the eigensolver takes as long for one as for as many
// as the units hold, ten or more each (docs/gpu.md).
BackendTraits OpenClBackend::traits() const {
  constexpr Index least_per_gpu_unit = 8;
  const DeviceInfo& device = device_.info();
  BackendTraits traits{.mixed = options_.precision == Precision::mixed};
  if (device.kind == DeviceKind::gpu)
    traits.least_segments =
        std::max(traits.least_segments, least_per_gpu_unit * device.compute_units);
  traits.full_segments = std::max(traits.least_segments, segments_per_unit * device.compute_units);
  return traits;
}

void OpenClBackend::prepare(const Method& method) {
  std::visit([this](const auto& chosen) { workers_.front()->prepare(chosen); }, method);
}

opencl::SegmentSize OpenClBackend::size_of(const SegmentBatch& data, Index b,
                                           const Method& method) const {
  opencl::SegmentSize size{
      .memory = 0,
      .stacked = static_cast<std::uint64_t>(data.rows(b) * data.pitch()) * sizeof(double)};
  std::visit(
      [&](const auto& chosen) {
        workers_.front()->with(chosen, [&](const auto& solver) {
          size.memory = solver.memory_of(data.rows(b), data.columns(), chosen);
        });
      },
      method);
  if (accepts_missing(method) && has_missing(data.segment(b))) size.memory += size.stacked;
  const DeviceInfo& device = device_.info();
  if (size.memory > options_.memory_limit || size.stacked > device.max_allocation)
    throw DeviceError(fmt::format(
        "a segment of {} frames x {} columns needs {} MiB, more than the {} MiB usable on {}; use "
        "shorter segments",
        data.rows(b), data.columns(), size.memory >> 20, options_.memory_limit >> 20, device.name));
  return size;
}

opencl::BatchPlan OpenClBackend::plan_of(const SegmentBatch& data, const Method& method) const {
  const DeviceInfo& device = device_.info();
  const bool lanes = tuning_.eigen == KernelForm::cpu;
  std::vector<opencl::SegmentSize> sizes;
  for (Index b = 0; b < data.segments(); ++b) sizes.push_back(size_of(data, b, method));
  return opencl::plan_batches(sizes, {.memory = options_.memory_limit,
                                      .allocation = device.max_allocation,
                                      .cache = shared_cache(device),
                                      .queues = queues_of(tuning_, device, method),
                                      .lanes = lanes ? vector_width(device_) : 1,
                                      .segments = tuning_.batch_segments});
}

// Workers are made when they are needed first: a small take needs one. Those that are too many keep
// their scratch memory for larger input, unless there is no room for it.
void OpenClBackend::prepare_workers(const opencl::BatchPlan& plan) {
  const auto wanted = static_cast<std::size_t>(plan.queues);
  const auto permitted = static_cast<std::size_t>(plan.permitted_queues);
  if (workers_.size() > permitted) workers_.resize(permitted);
  while (workers_.size() < wanted)
    workers_.push_back(
        std::make_unique<Worker>(device_, Device::AnotherQueue{}, options_, tuning_));
}

template <class Chosen>
void OpenClBackend::require_precision(const Chosen&) const {
  if (options_.precision == Precision::mixed)
    throw ArgumentError(fmt::format("{} works in double precision (f64) only", Chosen::name));
}

template <>
void OpenClBackend::require_precision(const RobustPca& method) const {
  if (options_.precision == Precision::mixed && method.tolerance < mixed_tolerance)
    throw ArgumentError(fmt::format(
        "mixed precision reaches a tolerance of {} at best, not {}; raise it or use f64",
        mixed_tolerance, method.tolerance));
}

Solution OpenClBackend::solve(const Problem& problem, const Method& method,
                              const Monitor& monitor) {
  std::visit(
      [this](const auto& chosen) {
        check(chosen);
        require_precision(chosen);
      },
      method);
  require_usable(problem, method);
  const SegmentBatch& data = problem.data;
  Solution solution = room_for_solution(data, method);
  FinishedCount counted(monitor, data.segments());
  const auto finished = [&](Index more) { counted(more); };
  prepare(method);
  const opencl::BatchPlan plan = plan_of(data, method);
  prepare_workers(plan);
  const auto solve_batch = [&](int worker, Index batch, const std::stop_token& stop) {
    const auto first = plan.first[static_cast<std::size_t>(batch)];
    const auto last = plan.first[static_cast<std::size_t>(batch) + 1];
    std::visit(
        [&](const auto& chosen) {
          Worker& own = *workers_[static_cast<std::size_t>(worker)];
          own.prepare(chosen);
          own.with(chosen, [&](auto& solver) {
            solver.solve(problem, first, last, chosen, solution, finished, stop);
          });
        },
        method);
  };
  opencl::for_each_concurrently(plan.queues, plan.batches(), monitor.stop, solve_batch);
  return solution;
}

}  // namespace moclean
