#include "moclean/solve/reference/reference_backend.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/solve/reference/matrix_completion.hpp"
#include "moclean/solve/reference/robust_pca.hpp"
#include "moclean/solve/reference/spectral.hpp"
#include "moclean/solve/reference/temporal_robust_pca.hpp"

namespace moclean {
namespace {

// Calls work(0) .. work(count - 1), each once, on up to `jobs` threads, the calling one included.
// After an exception no further call is started; the first one is rethrown when all have ended.
template <class Work>
void for_each_index(Index count, int jobs, const Work& work) {
  std::atomic<Index> next = 0;
  std::atomic<bool> failed = false;
  std::exception_ptr failure;
  const auto run = [&] {
    try {
      for (Index i = next++; i < count && !failed; i = next++) work(i);
    } catch (...) {
      if (!failed.exchange(true)) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (Index t = 1; t < std::min<Index>(jobs, count); ++t) others.emplace_back(run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

ReferenceBackend::ReferenceBackend(int jobs) : jobs_(jobs) {
  if (jobs < 1) throw ArgumentError(fmt::format("jobs is {}, expected at least 1", jobs));
}

std::string ReferenceBackend::name() const {
  return fmt::format("reference (Eigen {}.{}.{}, {} {})", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                     EIGEN_MINOR_VERSION, jobs_, jobs_ == 1 ? "thread" : "threads");
}

Solution ReferenceBackend::solve(const SegmentBatch& data, const Method& method,
                                 const Monitor& monitor) {
  std::visit([](const auto& m) { check(m); }, method);
  require_usable(data, method);

  Solution solution;
  solution.low_rank = SegmentBatch(data.columns(), data.first_rows());
  solution.sparse = SegmentBatch(data.columns(), data.first_rows());
  solution.segments.resize(static_cast<std::size_t>(data.segments()));
  std::mutex reporting;
  Progress progress{.finished = 0, .total = data.segments()};

  for_each_index(data.segments(), jobs_, [&](Index b) {
    std::visit(
        [&](const auto& m) {
          const auto segment = reference::solve(data.segment(b), m, monitor.stop);
          solution.low_rank.segment(b) = segment.low_rank;
          solution.sparse.segment(b) = segment.sparse;
          solution.segments[static_cast<std::size_t>(b)] = segment.outcome;
        },
        method);

    const std::lock_guard lock(reporting);
    ++progress.finished;
    if (monitor.report) monitor.report(progress);
  });
  return solution;
}

}  // namespace moclean
