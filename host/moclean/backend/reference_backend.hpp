#pragma once

#include "moclean/backend/backend.hpp"

namespace moclean {

/// Solves with Eigen on the host, in double, segment after segment: plain, slow and right.
///
/// With several jobs the segments are handed to as many threads. Results do not depend on the
/// number of jobs, bit for bit.
class ReferenceBackend final : public Backend {
 public:
  /// `jobs` threads; throws ArgumentError for less than 1.
  explicit ReferenceBackend(int jobs = 1);

  std::string name() const override;
  BackendTraits traits() const override;

  /// Reports after every segment. A stop request takes effect within one iteration of each thread.
  Solution solve(const Problem& problem, const Method& method,
                 const Monitor& monitor = {}) override;

 private:
  int jobs_;
};

}  // namespace moclean
