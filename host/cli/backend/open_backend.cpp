#include "cli/backend/open_backend.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "moclean/backend/opencl_backend.hpp"
#include "moclean/backend/reference_backend.hpp"
#include "moclean/run/job.hpp"

#include "cli/backend/tuning_cache.hpp"
#include "cli/printing/say.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

// What is kept for the device; a file that cannot be used is worth a warning.
std::optional<Tuning> kept_tuning(const fs::path& file, const DeviceInfo& device) {
  CachedTuning cached = read_tuning(file, device);
  if (!cached.problem.empty())
    warn("ignoring the kept tuning: {}; see moclean tune", cached.problem);
  return cached.tuning;
}

}  // namespace

OpenedBackend open_backend(const BackendOptions& options, bool needed, Profiling profiling) {
  if (!needed)
    return {nullptr, std::make_unique<ReferenceBackend>(options.jobs), {.name = "host (filters)"}};
  if (options.backend == "reference") {
    auto reference = std::make_unique<ReferenceBackend>(options.jobs);
    const std::string name = reference->name();
    return {nullptr, std::move(reference), {.name = name}};
  }
  auto device = std::make_unique<Device>(options.device, profiling);
  const fs::path file = options.use_tuning ? tuning_file(device->info()) : fs::path();
  const std::optional<Tuning> kept = kept_tuning(file, device->info());
  auto backend = std::make_unique<OpenClBackend>(
      *device, OpenClOptions{.form = options.form,
                             .products = options.products,
                             .precision = options.precision,
                             .memory_limit = std::min(device->info().usable_memory(),
                                                      device_share(options.memory_limit)),
                             .tuning = kept,
                             .jobs = options.jobs});
  BackendReport report{.name = backend->name(),
                       .tuning = backend->tuning(),
                       .tuning_file = kept ? file : fs::path()};
  return {std::move(device), std::move(backend), std::move(report)};
}

}  // namespace moclean::cli
