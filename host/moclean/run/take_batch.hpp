#pragma once

#include <optional>
#include <vector>

#include "moclean/denoise/denoiser.hpp"
#include "moclean/run/memory_budget.hpp"

namespace moclean {

/// Bytes a take needs: `copies` of its samples, one of its skeleton's channels, and what its
/// file is kept for.
std::uint64_t bytes_of(const Recording& take, std::uint64_t copies);

/// A take on its way through a run, all but what was recorded.
struct TakeInHand {
  std::size_t index = 0;  ///< of its file
  Index segments = 0;
  double read_seconds = 0;
  MemoryShare memory = {};
  std::optional<Recording> truth = {};  ///< from before it is solved, where there is one
  Denoised result = {};                 ///< from when it is solved
  std::optional<Matrix> mask = {};  ///< of status_numbers(); from when it is solved, if asked for
};

/// Takes that follow one another in the list of files and are solved together.
struct TakeBatch {
  std::vector<Recording>
      clips;  ///< as recorded; apart from the rest, for a denoiser takes them in a row
  std::vector<TakeInHand> takes;  ///< one per clip

  std::size_t size() const { return takes.size(); }
  std::uint64_t bytes() const;  ///< of memory shares
  Index segments() const;

  /// Lets go of a take and its memory.
  void drop(std::size_t place);
};

}  // namespace moclean
