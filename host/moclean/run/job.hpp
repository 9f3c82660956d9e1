#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "moclean/denoise/chain.hpp"
#include "moclean/run/inputs.hpp"
#include "moclean/run/outputs.hpp"
#include "moclean/run/process_memory.hpp"

namespace moclean {

/// The share of a memory limit that batches of a device may take; the rest is for the host.
constexpr std::uint64_t device_share(std::uint64_t memory_limit) { return memory_limit / 4; }

/// What a take that fails means for the others.
enum class FailurePolicy {
  all_or_nothing,  ///< the run ends and nothing is written for any
  each_on_its_own  ///< it is recorded with its error, and the others are written
};

/// A result that is complete but does not have its name yet.
struct CompleteFile {
  std::filesystem::path target;
  std::filesystem::path temporary;  ///< where its bytes are
};

/// Is told of all results of a take before they get their names, from any thread of the run; what
/// it throws is a failure of the take.
using BeforeCommit = std::function<void(std::size_t take, const std::vector<CompleteFile>& files)>;

/// What a run works on: all but the backend, as plain values.
struct Job {
  std::vector<std::filesystem::path> files = {};  ///< one per take
  ReadOptions reading = {};
  OutputPlan outputs = {};                         ///< see plan_outputs()
  std::vector<std::filesystem::path> truths = {};  ///< one per file, see truths_of(); empty: none
  std::optional<FrameRange> truth_frames = {};     ///< default: those of the takes

  /// Take spikes out of the rotations of skeletons before all else; see clean_rotations().
  bool from_rotations = false;
  Chain chain = {Automatic{}};
  std::optional<double> max_gap = {};  ///< seconds; longer gaps stay missing
  bool keep_observed = false;          ///< pass trusted samples through
  bool verify = false;  ///< solve with the reference, too; a take fails if they differ

  int jobs = 1;                                         ///< threads of each stage
  std::uint64_t memory_limit = default_memory_limit();  ///< bytes; see device_share()
  bool overlap = true;  ///< of the stages; without it all takes are in memory at once
  BeforeCommit before_commit = {};
  FailurePolicy on_failure = FailurePolicy::all_or_nothing;
};

}  // namespace moclean
