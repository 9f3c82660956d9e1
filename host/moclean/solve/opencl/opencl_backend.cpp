#include "moclean/solve/opencl/opencl_backend.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "moclean/solve/opencl/robust_pca.hpp"

namespace moclean {
namespace {

/// Share of a CPU's last-level cache that a batch should fit into. An iteration reads and writes
/// all of a batch; at 14 to 20 of 32 MiB it takes a tenth less processor time than from main
/// memory, and with less than that a batch leaves cores and vector lanes without work.
constexpr double cache_share = 0.5;
/// Segments below which a batch is not divided for the cache's sake: it would leave vector lanes
/// and cores without work.
constexpr Index least_segments = 4;

/// Bytes a batch of these segments should have, so that batches are of equal size and fit the cache
/// of a CPU; no bound on other devices.
std::uint64_t comfortable_size(const std::vector<std::uint64_t>& bytes, const DeviceInfo& device) {
  const double room = cache_share * static_cast<double>(device.global_cache);
  if (device.kind != DeviceKind::cpu || room <= 0) return std::numeric_limits<std::uint64_t>::max();
  const auto total = static_cast<double>(std::reduce(bytes.begin(), bytes.end()));
  return static_cast<std::uint64_t>(std::ceil(total / std::ceil(total / room)));
}

/// How large a batch may be, and should be.
struct BatchLimits {
  std::uint64_t bytes, comfortable;
  Index segments;
};

BatchLimits limits_of(const std::vector<std::uint64_t>& bytes, std::uint64_t limit,
                      const Tuning& tuning, const DeviceInfo& device) {
  if (tuning.batch_segments > 0) return {limit, limit, tuning.batch_segments};
  return {limit, comfortable_size(bytes, device), std::numeric_limits<Index>::max()};
}

/// First segment past a batch that starts with `first` and is within its limits; one stacked matrix
/// must fit into one allocation, too. bytes[b] is what segment b takes.
Index batch_end(const SegmentBatch& data, Index first, const std::vector<std::uint64_t>& bytes,
                const BatchLimits& limits, const DeviceInfo& device) {
  std::uint64_t taken = 0, stacked = 0;
  Index last = first;
  for (; last < data.segments() && last - first < limits.segments; ++last) {
    const std::uint64_t next = bytes[static_cast<std::size_t>(last)];
    stacked += static_cast<std::uint64_t>(data.rows(last) * data.pitch()) * sizeof(double);
    if (taken + next > limits.bytes || stacked > device.max_allocation) break;
    // Half a segment more than comfortable is better than a remainder of one segment at the end.
    if (last - first >= least_segments && taken + next / 2 > limits.comfortable) break;
    taken += next;
  }
  if (last == first)
    throw DeviceError(fmt::format(
        "a segment of {} frames x {} columns needs {} MiB, more than the {} MiB usable on {}; use "
        "shorter segments",
        data.rows(first), data.columns(), bytes[static_cast<std::size_t>(first)] >> 20,
        limits.bytes >> 20, device.name));
  return last;
}

Tuning tuning_of(const Device& device, const OpenClOptions& options) {
  Tuning tuning = options.tuning.value_or(default_tuning(device.info()));
  const bool mixed = options.precision == Precision::mixed;
  if (mixed && options.products == ProductPath::clblast)
    throw ArgumentError("mixed precision works with our own products only, not with CLBlast's");
  if (mixed) tuning.products = ProductPath::own;
  if (options.products) tuning.products = *options.products;
  return tuning;
}

}  // namespace

struct OpenClBackend::Solvers {
  using RobustPca = std::variant<opencl::RobustPcaSolver<double>, opencl::RobustPcaSolver<float>>;
  static RobustPca robust_pca_of(const Device& device, Precision precision, const Tuning& tuning) {
    if (precision == Precision::mixed) return opencl::RobustPcaSolver<float>(device, tuning);
    return opencl::RobustPcaSolver<double>(device, tuning);
  }

  RobustPca robust_pca;
};

OpenClBackend::OpenClBackend(const Device& device, const OpenClOptions& options)
    : device_(device), options_(options), tuning_(tuning_of(device, options)) {
  if (options_.memory_limit == 0) options_.memory_limit = device.info().usable_memory();
  solvers_.reset(new Solvers{Solvers::robust_pca_of(device, options.precision, tuning_)});
}

OpenClBackend::~OpenClBackend() = default;

std::string OpenClBackend::name() const {
  return fmt::format("opencl ({}, products {}{})", device_.info().name, to_string(tuning_.products),
                     options_.precision == Precision::mixed ? ", mixed precision" : "");
}

void OpenClBackend::require_reachable(const RobustPca& method) const {
  if (options_.precision == Precision::mixed && method.tolerance < mixed_tolerance)
    throw ArgumentError(fmt::format(
        "mixed precision reaches a tolerance of {} at best, not {}; raise it or use f64",
        mixed_tolerance, method.tolerance));
}

Solution OpenClBackend::solve(const SegmentBatch& data, const Method& method,
                              const Monitor& monitor) {
  std::visit(
      [this](const auto& chosen) {
        check(chosen);
        require_reachable(chosen);
      },
      method);
  require_finite(data);
  Solution solution{SegmentBatch(data.columns(), data.first_rows()),
                    SegmentBatch(data.columns(), data.first_rows()),
                    std::vector<SegmentOutcome>(static_cast<std::size_t>(data.segments()))};
  Progress progress{.finished = 0, .total = data.segments()};
  const auto finished = [&](Index count) {
    progress.finished += count;
    if (monitor.report) monitor.report(progress);
  };
  std::visit(
      [&](const auto& chosen, auto& solver) {
        std::vector<std::uint64_t> bytes;
        for (Index b = 0; b < data.segments(); ++b)
          bytes.push_back(solver.memory_of(data.rows(b), data.columns(), chosen));
        const BatchLimits limits = limits_of(bytes, options_.memory_limit, tuning_, device_.info());
        for (Index first = 0; first < data.segments();) {
          const Index last = batch_end(data, first, bytes, limits, device_.info());
          solver.solve(data, first, last, chosen, solution, finished, monitor.stop);
          first = last;
        }
      },
      method, solvers_->robust_pca);
  return solution;
}

}  // namespace moclean
