#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <queue>
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

/// The time during which at least one of several queues was busy.
class BusyTime {
 public:
  /// A launch, in nanoseconds of the device's clock. Launches may come in another order than that
  /// of their starts, as long as fewer than `reordered` come in between.
  void add(std::uint64_t begin, std::uint64_t end);

  double seconds() const;

  static constexpr std::size_t reordered = 4096;

 private:
  struct Span {
    std::uint64_t begin, end;
    auto operator<=>(const Span&) const = default;
  };
  /// Time of the union of the spans before, the last of which ends at `end`.
  struct Union {
    std::uint64_t time = 0, end = 0;
    void add(const Span& span);
  };

  std::priority_queue<Span, std::vector<Span>, std::greater<>> recent_;
  Union before_;
};

/// Collects the profiling events of a device's launches, of all its queues; threads may share it. A
/// library's own launches (CLBlast) are not among them.
class Profile {
 public:
  /// Takes the event of a launch that was enqueued.
  void record(const std::string& kernel, cl::Event event, const std::optional<Work>& work);

  /// Waits for the launches, and returns their kernels, the one with the most time first.
  std::vector<KernelProfile> kernels();

  /// Waits for the launches, and returns how long at least one of them ran. The sum over kernels is
  /// larger by the time in which launches of several queues shared the device.
  double busy_seconds();

  /// Waits for the launches, and forgets them and all before.
  void clear();

 private:
  struct Launch {
    KernelProfile* kernel;
    cl::Event event;
  };
  void add_oldest();
  void add_pending();

  std::mutex mutex_;
  std::map<std::string, KernelProfile> kernels_;
  std::deque<Launch> pending_;  // in the order in which they were recorded
  BusyTime busy_;
};

}  // namespace moclean
