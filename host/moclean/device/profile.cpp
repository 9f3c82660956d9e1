#include "moclean/device/profile.hpp"

#include <algorithm>

namespace moclean {
namespace {

// Events a driver keeps for us before those that are over are read and let go.
constexpr std::size_t most_pending = 256;

bool is_over(const cl::Event& event) {
  return event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() == CL_COMPLETE;
}

}  // namespace

void Profile::record(const std::string& kernel, const cl::Event& event,
                     const std::optional<Work>& work) {
  KernelProfile& profile = kernels_[kernel];
  if (profile.calls == 0) {
    profile.kernel = kernel;
    profile.work = Work{};
  }
  if (!work)
    profile.work.reset();
  else if (profile.work)
    *profile.work += *work;
  ++profile.calls;
  pending_.push_back({&profile, event});
  translate_opencl_errors("to profile kernel " + kernel, [&] {
    while (pending_.size() > most_pending && is_over(pending_.front().event)) add_oldest();
  });
}

void Profile::add_oldest() {
  const Launch& launch = pending_.front();
  const cl_ulong begin = launch.event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
  const cl_ulong end = launch.event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
  launch.kernel->seconds += 1e-9 * static_cast<double>(end - begin);
  pending_.pop_front();
}

std::vector<KernelProfile> Profile::kernels() {
  translate_opencl_errors("to profile kernels", [&] {
    while (!pending_.empty()) {
      pending_.front().event.wait();
      add_oldest();
    }
  });
  std::vector<KernelProfile> all;
  for (const auto& [name, profile] : kernels_) all.push_back(profile);
  std::ranges::stable_sort(all, std::ranges::greater{}, &KernelProfile::seconds);
  return all;
}

void Profile::clear() {
  kernels();
  kernels_.clear();
}

}  // namespace moclean
