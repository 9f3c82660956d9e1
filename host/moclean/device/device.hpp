#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/device/opencl.hpp"
#include "moclean/device/profile.hpp"

namespace moclean {

enum class DeviceKind { cpu, gpu, other };

std::string to_string(DeviceKind kind);

/// What a device says about itself.
struct DeviceInfo {
  int platform = 0;  ///< index of its platform
  int index = 0;     ///< index among the devices of that platform
  std::string name;
  std::string platform_name;
  std::string driver;
  std::string version;
  DeviceKind kind = DeviceKind::other;
  bool fp64 = false;  ///< cl_khr_fp64
  int compute_units = 0;
  int vector_width = 1;             ///< native vector width in doubles, 1 where fp64 is missing
  std::uint64_t global_memory = 0;  ///< bytes
  std::uint64_t global_cache = 0;   ///< bytes of the cache before it; 0 where the driver tells none
  std::uint64_t max_allocation = 0;  ///< bytes of one buffer
  std::uint64_t local_memory = 0;    ///< bytes per work-group
  std::size_t max_work_group = 0;    ///< work-items

  /// Bytes that a program may take without asking: three quarters of the device's memory.
  std::uint64_t usable_memory() const { return global_memory / 4 * 3; }
};

/// Every device of every platform; empty if there is none.
std::vector<DeviceInfo> list_devices();

/// One line for people: `0:0 pthread-skylake (cpu, 2 units, 3.4 GiB, fp64)`.
std::string describe(const DeviceInfo& info);

/// Whether the time of every launch is taken, which needs another kind of queue.
enum class Profiling { off, on };

/// Programs that were built for a context, by source and options: building one takes some 20 ms
/// even where the driver has kept its binary. Threads may share it.
class BuiltPrograms {
 public:
  /// What `build` returned for this key when it was called first; nothing is kept if it throws.
  /// Others wait while it builds.
  template <class Build>
  cl::Program find_or_build(const std::string& key, const Build& build) {
    const std::lock_guard lock(mutex_);
    const auto found = programs_.find(key);
    return found != programs_.end() ? found->second : programs_.emplace(key, build()).first->second;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, cl::Program> programs_;
};

/// An OpenCL device with a context and an in-order queue of its own. Not copyable; buffers, kernels
/// and programs keep what they need of it alive. One thread at a time may use its queue.
class Device {
 public:
  /// Opens the device that `selection` names: empty (best: fp64 before none, GPU before CPU),
  /// `cpu`, `gpu`, `P:D` (platform and device index), or a fragment of its or its platform's name
  /// in any case. Throws DeviceError listing what there is if none matches; there is no fall-back.
  explicit Device(std::string_view selection = {}, Profiling profiling = Profiling::off);

  /// The same device, context, programs and profile with a queue of its own: what one thread
  /// enqueues here runs beside what another enqueues on `first`, which has to outlive this.
  struct AnotherQueue {};
  Device(const Device& first, AnotherQueue);

  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const { return info_; }
  const cl::Context& context() const { return context_; }
  const cl::CommandQueue& queue() const { return queue_; }
  const cl::Device& handle() const { return device_; }

  /// The launches so far, of all its queues; null unless the device was opened with Profiling::on.
  Profile* profile() const { return profile_; }

  /// The programs of its context.
  BuiltPrograms& programs() const { return *programs_; }

  /// Waits until everything enqueued is done.
  void finish() const;

 private:
  DeviceInfo info_;
  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::unique_ptr<Profile> own_profile_;         // of the first queue
  std::unique_ptr<BuiltPrograms> own_programs_;  // of the first queue
  Profile* profile_;
  BuiltPrograms* programs_;
};

}  // namespace moclean
