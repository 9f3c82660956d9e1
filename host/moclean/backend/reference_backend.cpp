#include "moclean/backend/reference_backend.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/parallel.hpp"
#include "moclean/methods/matrix_completion/reference.hpp"
#include "moclean/methods/matrix_normal/reference.hpp"
#include "moclean/methods/robust_pca/reference.hpp"
#include "moclean/methods/spectral/reference.hpp"
#include "moclean/methods/temporal_robust_pca/reference.hpp"

namespace moclean {
namespace {

template <class M>
auto solve_segment(const Problem& problem, Index b, const M& method, const std::stop_token& stop) {
  const auto segment = problem.data.segment(b);
  if constexpr (requires { M::takes_prior; })
    return reference::solve(segment, method, stop, problem.prior(b));
  else
    return reference::solve(segment, method, stop);
}

}  // namespace

ReferenceBackend::ReferenceBackend(int jobs) : jobs_(jobs) {
  if (jobs < 1) throw ArgumentError(fmt::format("jobs is {}, expected at least 1", jobs));
}

std::string ReferenceBackend::name() const {
  return fmt::format("reference (Eigen {}.{}.{}, {} {})", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                     EIGEN_MINOR_VERSION, jobs_, jobs_ == 1 ? "thread" : "threads");
}

BackendTraits ReferenceBackend::traits() const {
  BackendTraits traits;
  traits.full_segments = std::max(traits.least_segments, segments_per_unit * jobs_);
  return traits;
}

Solution ReferenceBackend::solve(const Problem& problem, const Method& method,
                                 const Monitor& monitor) {
  std::visit([](const auto& m) { check(m); }, method);
  require_usable(problem, method);
  const SegmentBatch& data = problem.data;
  Solution solution = room_for_solution(data, method);
  FinishedCount finished(monitor, data.segments());

  for_each_index(data.segments(), jobs_, [&](Index b) {
    std::visit(
        [&](const auto& m) {
          const auto segment = solve_segment(problem, b, m, monitor.stop);
          solution.low_rank.segment(b) = segment.low_rank;
          solution.sparse.segment(b) = segment.sparse;
          if constexpr (requires { segment.trusted; }) {
            solution.trusted->segment(b) = segment.trusted;
            solution.deviation->segment(b) = segment.deviation;
          }
          solution.segments[static_cast<std::size_t>(b)] = segment.outcome;
        },
        method);
    finished(1);
  });
  return solution;
}

}  // namespace moclean
