// Time and work of every kernel while the first take is solved.
#include "moclean/backend/opencl_backend.hpp"

#include "suite/sections.hpp"
#include "suite/takes.hpp"

namespace moclean::bench {

nlohmann::json measure_kernels(const Settings& settings, const Device& device) {
  const Device profiled(device.info().name, Profiling::on);
  OpenClBackend backend(profiled);
  const NoisyTake take = noisy_takes(settings.data).front();
  nlohmann::json record;
  for (const Index length : {200, 400}) {
    const Workload workload = cut_into_segments(take, length);
    backend.solve(workload.data, RobustPca{});
    profiled.profile()->clear();
    backend.solve(workload.data, RobustPca{});
    for (const KernelProfile& kernel : profiled.profile()->kernels()) {
      record.push_back({{"workload", workload.name},
                        {"kernel", kernel.kernel},
                        {"calls", kernel.calls},
                        {"seconds", kernel.seconds}});
      if (!kernel.work) continue;
      record.back()["flops"] = kernel.work->flops;
      record.back()["bytes"] = kernel.work->bytes;
    }
  }
  return record;
}

}  // namespace moclean::bench
