#include "suite/answer.hpp"

#include <thread>

#include <fmt/format.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/core/error.hpp"

namespace moclean::bench {
namespace {

constexpr Index largest_for_reference = 64;

}  // namespace

Solution right_answer(const SegmentBatch& data) {
  const int threads = static_cast<int>(std::thread::hardware_concurrency());
  if (data.segments() > largest_for_reference)
    return lapack_textbook(threads).backend->solve(data, RobustPca{});
  return ReferenceBackend(threads).solve(data, RobustPca{});
}

double difference(const Solution& solution, const Solution& right, const Contestant& contestant,
                  const std::string& workload) {
  double largest = 0;
  for (Index b = 0; b < right.low_rank.segments(); ++b) {
    const ConstMatrixView A = right.low_rank.segment(b);
    const double relative = (solution.low_rank.segment(b) - A).norm() / A.norm();
    const int iterations = solution.segments[static_cast<std::size_t>(b)].iterations;
    const int expected = right.segments[static_cast<std::size_t>(b)].iterations;
    const bool comparable = contestant.method == RobustPca{};
    if (!(relative <= contestant.agreement) || (comparable && iterations != expected))
      throw Error(fmt::format(
          "{} is wrong on {}, segment {}: A differs by {:.1e} (at most {:.1e}), {} iterations ({})",
          contestant.name, workload, b, relative, contestant.agreement, iterations, expected));
    largest = std::max(largest, relative);
  }
  return largest;
}

}  // namespace moclean::bench
