#pragma once

#include <filesystem>
#include <future>
#include <stop_token>
#include <thread>
#include <vector>

#include "moclean/denoise/low_rank.hpp"
#include "moclean/run/busy_clock.hpp"
#include "moclean/run/inputs.hpp"
#include "moclean/run/memory_budget.hpp"

namespace moclean {

/// Takes that follow one another in the list of files and are solved together.
struct TakeGroup {
  std::size_t first = 0;  ///< index of the first one's file
  std::vector<Clip> clips;
  std::vector<double> read_seconds;  ///< per clip
  std::vector<MemoryShare> memory;   ///< per clip
  Index segments = 0;                ///< of all clips

  std::uint64_t bytes() const;
};

/// How takes are put together.
struct GroupRules {
  Segmentation segmentation;
  Index least_segments = 64;  ///< what keeps a small device busy
  Index full_segments = 64;   ///< what fills this device: a group that has so many ends
  /// Bytes of memory a take needs at most, per byte of its samples: the copies of all stages.
  std::uint64_t copies = 7;
  InputNeeds needs = {};
};

/// Reads recordings on threads of its own, in the order of their files and ahead of what is asked
/// for, as far as the memory budget goes.
///
/// A group ends before a take that would let it fill more than a third of the budget, so that one
/// group can be read and one written while one is solved; after `full_segments`; and, so that the
/// stages overlap on large devices too, after a quarter of all input with `least_segments`.
class TakeReader {
 public:
  /// The files, the budget and what `stop` belongs to outlive the reader.
  TakeReader(const std::vector<std::filesystem::path>& files, const InputOptions& options,
             const GroupRules& rules, int threads, MemoryBudget& budget, std::stop_token stop);
  ~TakeReader();
  TakeReader(const TakeReader&) = delete;
  TakeReader& operator=(const TakeReader&) = delete;

  /// Waits for the next takes; without any at the end. Throws what reading the first bad file
  /// threw, FileError for a take that needs more than the whole budget, Cancelled when it is
  /// stopped.
  TakeGroup next();

  /// Segments of all takes, as far as the size of the files not read yet lets one estimate.
  Index expected_segments() const;
  bool at_end() const { return given_ == files_.size(); }

  double seconds() const { return clock_.seconds(); }  ///< wall time some file was being read

 private:
  struct Take {
    Clip clip;
    double seconds = 0;
    MemoryShare memory;
  };

  void read_ahead();
  Take read(std::size_t index, MemoryShare memory);
  void require_room(std::size_t index, std::uint64_t bytes) const;
  std::uint64_t expected_bytes(std::size_t index) const;
  bool takes_another(const TakeGroup& group, std::uintmax_t file_bytes) const;

  const std::vector<std::filesystem::path>& files_;
  const InputOptions& options_;
  const GroupRules rules_;
  MemoryBudget& budget_;
  std::vector<std::uintmax_t> file_bytes_;  // per file
  std::uintmax_t all_bytes_ = 0;
  std::size_t given_ = 0;  // takes that next() has given
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
