#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <stop_token>

namespace moclean {

class MemoryBudget;

/// Bytes taken out of a MemoryBudget, given back when it is destroyed. The budget outlives it.
class MemoryShare {
 public:
  MemoryShare() = default;
  MemoryShare(MemoryShare&& other) noexcept;
  MemoryShare& operator=(MemoryShare&& other) noexcept;
  ~MemoryShare() { resize(0); }

  std::uint64_t bytes() const { return bytes_; }

  /// Gives back or takes the difference; never waits, so a share may grow beyond the limit.
  void resize(std::uint64_t bytes);

 private:
  friend MemoryBudget;
  MemoryShare(MemoryBudget& budget, std::uint64_t bytes) : budget_(&budget), bytes_(bytes) {}

  MemoryBudget* budget_ = nullptr;
  std::uint64_t bytes_ = 0;
};

/// Makes the stages of a run wait until there is memory for their next take.
///
/// It counts what it is told and allocates nothing. Any number of threads may use it.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t limit) : limit_(limit) {}
  MemoryBudget(const MemoryBudget&) = delete;
  MemoryBudget& operator=(const MemoryBudget&) = delete;

  std::uint64_t limit() const { return limit_; }

  /// Waits until so many bytes are free, or until nothing is taken: a share above the limit is
  /// given when it is the only one. Throws Cancelled when a stop is requested.
  MemoryShare take(std::uint64_t bytes, const std::stop_token& stop);

 private:
  friend MemoryShare;
  void change(std::uint64_t from, std::uint64_t to);

  const std::uint64_t limit_;
  std::mutex mutex_;
  std::condition_variable_any freed_;
  std::uint64_t taken_ = 0;
};

}  // namespace moclean
