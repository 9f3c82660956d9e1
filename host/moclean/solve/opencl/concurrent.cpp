#include "moclean/solve/opencl/concurrent.hpp"

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "moclean/core/error.hpp"

namespace moclean::opencl {
namespace {

/// The first exception of several threads.
class FirstFailure {
 public:
  explicit FirstFailure(std::stop_source& others) : others_(others) {}

  /// Called where an exception is being handled.
  void keep() {
    {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
    others_.request_stop();  // afterwards, so that their Cancelled comes second
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::stop_source& others_;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace

void for_each_concurrently(int workers, Index items, const std::stop_token& stop,
                           const ItemWork& work) {
  std::stop_source stop_all;
  const std::stop_callback caller_stops(stop, [&] { stop_all.request_stop(); });
  FirstFailure failure(stop_all);
  std::atomic<Index> next = 0;
  const auto run = [&](int worker) {
    try {
      for (Index item = next++; item < items; item = next++) {
        if (stop_all.stop_requested()) throw Cancelled();
        work(worker, item, stop_all.get_token());
      }
    } catch (...) {
      failure.keep();
    }
  };
  {
    std::vector<std::jthread> others;  // joined at the end of this block
    try {
      for (int worker = 1; worker < workers; ++worker) others.emplace_back(run, worker);
    } catch (...) {  // no more threads to be had
      failure.keep();
    }
    run(0);
  }
  failure.rethrow();
}

}  // namespace moclean::opencl
