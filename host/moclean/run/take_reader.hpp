#pragma once

#include <functional>
#include <future>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "moclean/run/batch_rules.hpp"
#include "moclean/run/busy_clock.hpp"
#include "moclean/run/memory_budget.hpp"
#include "moclean/run/run_log.hpp"
#include "moclean/run/take_batch.hpp"

namespace moclean {

/// Reads recordings on threads of its own, in the order of their files and ahead of what is asked
/// for, as far as the memory budget goes.
///
/// A batch ends before a take that would let it fill more than a third of the budget, so that one
/// batch can be read and one written while one is solved; after `full_segments`; and, so that the
/// stages overlap on large devices too, after a quarter of all input with `least_segments`.
class TakeReader {
 public:
  /// All of them outlive the reader.
  TakeReader(const Job& job, const BatchRules& rules, MemoryBudget& budget, RunLog& log,
             std::stop_token stop);
  ~TakeReader();
  TakeReader(const TakeReader&) = delete;
  TakeReader& operator=(const TakeReader&) = delete;

  /// Waits for the next takes; without any at the end. A take fails (see RunLog) with what reading
  /// it threw, and FileError if it needs more than the whole budget. Throws Cancelled when it is
  /// stopped.
  TakeBatch next();

  /// Segments of all takes, as far as the size of the files not read yet lets one estimate.
  Index expected_segments() const;
  bool at_end() const { return given_ == job_.files.size(); }

  double seconds() const { return clock_.seconds(); }  ///< wall time some file was being read

 private:
  struct Take {
    Recording clip;
    double seconds = 0;
    MemoryShare memory;
  };

  void read_ahead();
  Take read(std::size_t index, MemoryShare memory);
  void require_room(std::size_t index, std::uint64_t bytes) const;
  std::uint64_t expected_bytes(std::size_t index) const;
  bool takes_another(const TakeBatch& batch, std::uintmax_t file_bytes) const;

  const Job& job_;
  const BatchRules& rules_;
  MemoryBudget& budget_;
  RunLog& log_;
  std::vector<std::uintmax_t> file_bytes_;  // per file
  std::uintmax_t all_bytes_ = 0;
  std::size_t given_ = 0;  // takes that next() has given or that failed
  std::uintmax_t given_bytes_ = 0;
  Index given_segments_ = 0;
  BusyClock clock_;

  std::vector<std::promise<Take>> promises_;  // per file
  std::vector<std::future<Take>> takes_;      // per file
  std::mutex admission_;  // held while a thread waits for memory: takes get it in their order
  std::size_t next_ = 0;  // file to be read next
  std::stop_source stop_;
  std::stop_callback<std::function<void()>> stopped_;
  std::vector<std::jthread> threads_;  // last: they use the others
};

}  // namespace moclean
