#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <variant>

#include "moclean/backend/backend.hpp"

namespace moclean {

/// A take is in memory. Takes are counted from 0, in the order of the job's files.
struct TakeRead {
  std::size_t take = 0;
};

/// Which backend solves: the one that was given, or the reference that it is compared with.
enum class SolveTask { solving, verifying };

/// Segments were solved.
struct SegmentsSolved {
  SolveTask task = SolveTask::solving;
  Progress progress;           ///< of all takes
  bool total_is_exact = true;  ///< or estimated from the size of files not read yet
};

struct TakeReport;

/// All results of a take stand under their names.
struct TakeWritten {
  std::size_t take = 0;
  const TakeReport* report = nullptr;  ///< complete; for as long as the sink is told
};

/// Nothing will be written for a take.
struct TakeFailed {
  std::size_t take = 0;
  std::string problem;                 ///< a complete message that names the file
  const TakeReport* report = nullptr;  ///< as far as the take came; likewise
};

/// What happens during a run.
using RunEvent = std::variant<TakeRead, SegmentsSolved, TakeWritten, TakeFailed>;

/// Is told what happens, from any thread of the run but from one at a time. Throws nothing.
using EventSink = std::function<void(const RunEvent&)>;

}  // namespace moclean
