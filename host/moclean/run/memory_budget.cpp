#include "moclean/run/memory_budget.hpp"

#include <utility>

#include "moclean/core/error.hpp"

namespace moclean {

MemoryShare::MemoryShare(MemoryShare&& other) noexcept
    : budget_(std::exchange(other.budget_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}

MemoryShare& MemoryShare::operator=(MemoryShare&& other) noexcept {
  if (this == &other) return *this;
  resize(0);
  budget_ = std::exchange(other.budget_, nullptr);
  bytes_ = std::exchange(other.bytes_, 0);
  return *this;
}

void MemoryShare::resize(std::uint64_t bytes) {
  if (budget_) budget_->change(bytes_, bytes);
  bytes_ = bytes;
}

MemoryShare MemoryBudget::take(std::uint64_t bytes, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  freed_.wait(lock, stop, [&] { return taken_ == 0 || taken_ + bytes <= limit_; });
  if (stop.stop_requested()) throw Cancelled();
  taken_ += bytes;
  return {*this, bytes};
}

void MemoryBudget::change(std::uint64_t from, std::uint64_t to) {
  {
    const std::lock_guard lock(mutex_);
    taken_ = taken_ - from + to;
  }
  freed_.notify_all();
}

}  // namespace moclean
