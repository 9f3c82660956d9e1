#pragma once

#include <exception>
#include <filesystem>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "moclean/core/error.hpp"
#include "moclean/run/events.hpp"
#include "moclean/run/job.hpp"

namespace moclean {

/// Calls `work`; where the memory does not suffice, the error names the file and what was done.
template <class Work>
auto naming(const std::filesystem::path& file, const char* deed, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw FileError(file, std::string("there is not enough memory to ") + deed);
  }
}

/// Tells the sink of a run what happens, and keeps which takes failed. Any number of threads may
/// use it.
class RunLog {
 public:
  RunLog(FailurePolicy policy, std::size_t takes, EventSink sink)
      : policy_(policy), sink_(std::move(sink)), problems_(takes) {}

  /// A failure is to end the run.
  bool all_or_nothing() const { return policy_ == FailurePolicy::all_or_nothing; }

  void send(const RunEvent& event) {
    const std::lock_guard lock(mutex_);
    if (sink_) sink_(event);
  }

  /// Works on a take; false if that failed and the others go on, else throws what `work` threw. To
  /// be cancelled is no failure.
  template <class Work>
  bool attempt(std::size_t take, const Work& work) {
    try {
      work();
      return true;
    } catch (const Cancelled&) {
      throw;
    } catch (const std::exception& error) {
      add_failure(take, error.what());
      if (all_or_nothing()) throw;
      return false;
    }
  }

  /// Why a take failed; empty if it did not.
  std::string problem(std::size_t take) const {
    const std::lock_guard lock(mutex_);
    return problems_[take];
  }

 private:
  void add_failure(std::size_t take, const std::string& problem) {
    const std::lock_guard lock(mutex_);
    problems_[take] = problem;
    if (sink_) sink_(TakeFailed{take, problem});
  }

  const FailurePolicy policy_;
  mutable std::mutex mutex_;
  const EventSink sink_;
  std::vector<std::string> problems_;  // per take
};

}  // namespace moclean
