#pragma once

#include <chrono>
#include <mutex>

namespace moclean {

/// Wall time during which at least one thread was at a certain work. Threads may share it.
class BusyClock {
 public:
  /// Counts a thread as busy while it lives, and measures how long that is.
  class Work {
   public:
    explicit Work(BusyClock& clock) : clock_(clock) { clock_.change(+1, begin_); }
    ~Work() { clock_.change(-1, Clock::now()); }
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;

    double seconds() const { return Seconds(Clock::now() - begin_).count(); }

   private:
    BusyClock& clock_;
    const std::chrono::steady_clock::time_point begin_ = Clock::now();
  };

  double seconds() const {
    const std::lock_guard lock(mutex_);
    return total_.count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;

  void change(int workers, Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    if (workers_ == 0) begin_ = now;
    workers_ += workers;
    if (workers_ == 0) total_ += now - begin_;
  }

  mutable std::mutex mutex_;
  int workers_ = 0;
  Clock::time_point begin_;
  Seconds total_{0};
};

}  // namespace moclean
