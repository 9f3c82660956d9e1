#include "moclean/solve/opencl/opencl_backend.hpp"

#include <fmt/format.h>

#include "moclean/solve/opencl/robust_pca.hpp"

namespace moclean {
namespace {

/// First segment past a batch that starts with `first` and fits into `limit` bytes; one stacked
/// matrix must fit into one allocation, too.
template <class MemoryOf>
Index batch_end(const SegmentBatch& data, Index first, std::uint64_t limit,
                const DeviceInfo& device, MemoryOf&& memory_of) {
  std::uint64_t bytes = 0, stacked = 0;
  Index last = first;
  for (; last < data.segments(); ++last) {
    bytes += memory_of(data.rows(last), data.columns());
    stacked += static_cast<std::uint64_t>(data.rows(last) * data.pitch()) * sizeof(double);
    if (bytes > limit || stacked > device.max_allocation) break;
  }
  if (last == first)
    throw DeviceError(fmt::format(
        "a segment of {} frames x {} columns needs {} MiB, more than the {} MiB usable on {}; use "
        "shorter segments",
        data.rows(first), data.columns(), bytes >> 20, limit >> 20, device.name));
  return last;
}

}  // namespace

struct OpenClBackend::Solvers {
  opencl::RobustPcaSolver robust_pca;
};

OpenClBackend::OpenClBackend(const Device& device, const OpenClOptions& options)
    : device_(device),
      options_(options),
      solvers_(new Solvers{opencl::RobustPcaSolver(device, options.products)}) {
  if (options_.memory_limit == 0) options_.memory_limit = device.info().global_memory / 4 * 3;
}

OpenClBackend::~OpenClBackend() = default;

std::string OpenClBackend::name() const {
  return fmt::format("opencl ({}, products {})", device_.info().name, to_string(options_.products));
}

Solution OpenClBackend::solve(const SegmentBatch& data, const Method& method,
                              const Monitor& monitor) {
  std::visit([](const auto& chosen) { check(chosen); }, method);
  require_finite(data);
  Solution solution{SegmentBatch(data.columns(), data.first_rows()),
                    SegmentBatch(data.columns(), data.first_rows()),
                    std::vector<SegmentOutcome>(static_cast<std::size_t>(data.segments()))};
  Progress progress{.finished = 0, .total = data.segments()};
  const auto finished = [&](Index count) {
    progress.finished += count;
    if (monitor.report) monitor.report(progress);
  };
  const auto solver_of = [this](const RobustPca&) -> auto& { return solvers_->robust_pca; };

  std::visit(
      [&](const auto& chosen) {
        auto& solver = solver_of(chosen);
        for (Index first = 0; first < data.segments();) {
          const Index last = batch_end(data, first, options_.memory_limit, device_.info(),
                                       [&](Index r, Index c) { return solver.memory_of(r, c); });
          solver.solve(data, first, last, chosen, solution, finished, monitor.stop);
          first = last;
        }
      },
      method);
  return solution;
}

}  // namespace moclean
