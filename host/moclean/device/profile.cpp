#include "moclean/device/profile.hpp"

#include <algorithm>
#include <utility>

namespace moclean {
namespace {

// Events a driver keeps for us before those that are over are read and let go.
constexpr std::size_t most_pending = 256;

bool is_over(const cl::Event& event) {
  return event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() == CL_COMPLETE;
}

}  // namespace

void BusyTime::Union::add(const Span& span) {
  if (span.end <= end) return;
  time += span.end - std::max(span.begin, end);
  end = span.end;
}

void BusyTime::add(std::uint64_t begin, std::uint64_t end) {
  recent_.push({begin, end});
  if (recent_.size() <= reordered) return;
  before_.add(recent_.top());
  recent_.pop();
}

double BusyTime::seconds() const {
  Union all = before_;
  for (auto left = recent_; !left.empty(); left.pop()) all.add(left.top());
  return 1e-9 * static_cast<double>(all.time);
}

void Profile::record(const std::string& kernel, cl::Event event, const std::optional<Work>& work) {
  const std::lock_guard lock(mutex_);
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
  pending_.push_back({&profile, std::move(event)});
  translate_opencl_errors("to profile kernel " + kernel, [&] {
    while (pending_.size() > most_pending && is_over(pending_.front().event)) add_oldest();
  });
}

void Profile::add_oldest() {
  const Launch& launch = pending_.front();
  const cl_ulong begin = launch.event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
  const cl_ulong end = launch.event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
  launch.kernel->seconds += 1e-9 * static_cast<double>(end - begin);
  busy_.add(begin, end);
  pending_.pop_front();
}

void Profile::add_pending() {
  translate_opencl_errors("to profile kernels", [&] {
    while (!pending_.empty()) {
      pending_.front().event.wait();
      add_oldest();
    }
  });
}

std::vector<KernelProfile> Profile::kernels() {
  const std::lock_guard lock(mutex_);
  add_pending();
  std::vector<KernelProfile> all;
  for (const auto& [name, profile] : kernels_) all.push_back(profile);
  std::ranges::stable_sort(all, std::ranges::greater{}, &KernelProfile::seconds);
  return all;
}

double Profile::busy_seconds() {
  const std::lock_guard lock(mutex_);
  add_pending();
  return busy_.seconds();
}

void Profile::clear() {
  const std::lock_guard lock(mutex_);
  add_pending();
  kernels_.clear();
  busy_ = {};
}

}  // namespace moclean
