#pragma once

#include <cstdint>

#include "moclean/denoise/low_rank.hpp"
#include "moclean/run/inputs.hpp"
#include "moclean/run/job.hpp"

namespace moclean {

/// How takes are put together, and what each of them needs.
struct BatchRules {
  Segmentation segmentation;
  BackendTraits backend = {};  ///< a batch that has its full segments ends
  /// Bytes of memory a take needs at most, per byte of its samples: the copies of all stages until
  /// it is solved, and from then on.
  std::uint64_t copies_solving = 7;
  std::uint64_t copies_writing = 2;
  InputNeeds needs = {};
};

/// The rules of a job on a backend.
BatchRules rules_of(const Job& job, const BackendTraits& backend);

}  // namespace moclean
