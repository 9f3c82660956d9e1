#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "moclean/device/opencl.hpp"

namespace moclean {

/// What a launch does, going by its formula: floating-point operations, and bytes that have to move
/// between memory and processor if everything is read once and written once.
struct Work {
  double flops = 0;
  double bytes = 0;

  Work& operator+=(const Work& other) {
    flops += other.flops;
    bytes += other.bytes;
    return *this;
  }
};

/// Time and work of all launches of a kernel.
struct KernelProfile {
  std::string kernel;
  int calls = 0;
  double seconds = 0;             ///< on the device, from start to end of each launch
  std::optional<Work> work = {};  ///< of all launches; empty if that of any is not known
};

/// Collects the profiling events of a device's launches. A library's own launches (CLBlast) are not
/// among them.
class Profile {
 public:
  /// Takes the event of a launch that was enqueued.
  void record(const std::string& kernel, const cl::Event& event, const std::optional<Work>& work);

  /// Waits for the launches, and returns their kernels, the one with the most time first.
  std::vector<KernelProfile> kernels();

  /// Waits for the launches, and forgets them and all before.
  void clear();

 private:
  struct Launch {
    KernelProfile* kernel;
    cl::Event event;
  };
  void add_oldest();

  std::map<std::string, KernelProfile> kernels_;
  std::deque<Launch> pending_;  // in the order of the queue
};

}  // namespace moclean
