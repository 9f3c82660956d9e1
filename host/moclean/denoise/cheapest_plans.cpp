#include "moclean/denoise/cheapest_plans.hpp"

#include <algorithm>
#include <map>

#include "moclean/filter/filter.hpp"
#include "moclean/segment/cheapest_plan.hpp"

namespace moclean {
namespace {

constexpr Index median_window = 9;
// A batch of candidates has no more frames than so many times all takes of its width.
constexpr Index takes_per_batch = 4;

// A segment that a plan may have.
struct Candidate {
  std::size_t take = 0;
  Span span;
};

// Squared distance; what is not observed does not count.
double squared_distance(const ConstMatrixRef& a, const ConstMatrixRef& b) {
  const Matrix difference = a - b;
  return difference.array().isNaN().select(0, difference.array()).square().sum();
}

std::vector<double> costs_of(std::span<const Candidate> candidates,
                             std::span<const Recording> takes, std::span<const Matrix> medians,
                             const RobustPca& method, Backend& backend,
                             const std::stop_token& stop) {
  std::vector<Index> first_row = {0};
  for (const Candidate& candidate : candidates)
    first_row.push_back(first_row.back() + candidate.span.frames());
  SegmentBatch batch(takes[candidates.front().take].samples.cols(), std::move(first_row));
  const auto rows_of = [](const Matrix& samples, const Span& span) {
    return samples.middleRows(span.first, span.frames());
  };
  Index segment = 0;
  for (const auto& [take, span] : candidates)
    batch.segment(segment++) = rows_of(takes[take].samples, span);

  const Solution solution = backend.solve(batch, method, {.stop = stop});
  std::vector<double> costs;
  for (const auto& [take, span] : candidates)
    costs.push_back(squared_distance(solution.low_rank.segment(static_cast<Index>(costs.size())),
                                     rows_of(medians[take], span)));
  return costs;
}

// Candidates of takes of one width, in batches.
std::vector<double> costs_in_batches(std::span<const Candidate> candidates, Index most_rows,
                                     const auto& costs_of_batch) {
  std::vector<double> costs;
  while (!candidates.empty()) {
    std::size_t count = 0;
    for (Index rows = 0; count < candidates.size(); ++count) {
      rows += candidates[count].span.frames();
      if (count > 0 && rows > most_rows) break;
    }
    for (const double cost : costs_of_batch(candidates.first(count))) costs.push_back(cost);
    candidates = candidates.subspan(count);
  }
  return costs;
}

}  // namespace

std::vector<SegmentPlan> cheapest_plans(std::span<const Recording> takes,
                                        std::span<const Index> segments, RobustPca method,
                                        Backend& backend, const std::stop_token& stop) {
  method.tolerance = std::max(method.tolerance, coarse_tolerance);
  std::vector<SegmentPlan> plans;
  std::vector<Matrix> medians(takes.size());
  std::map<Index, std::vector<Candidate>> by_width;
  std::map<Index, Index> rows;
  for (std::size_t t = 0; t < takes.size(); ++t) {
    plans.push_back(equal_segments(takes[t].frames(), segments[t]));
    if (!can_vary(takes[t].frames(), segments[t])) continue;
    medians[t] = filtered(takes[t], MedianFilter{.window = median_window});
    const Index width = takes[t].samples.cols();
    rows[width] += takes[t].frames();
    for (const Span& span : candidate_segments(takes[t].frames(), segments[t]))
      by_width[width].push_back({t, span});
  }
  for (const auto& [width, candidates] : by_width) {
    const std::vector<double> costs = costs_in_batches(
        candidates, takes_per_batch * rows[width], [&](std::span<const Candidate> some) {
          return costs_of(some, takes, medians, method, backend, stop);
        });
    auto cost = costs.begin();
    for (auto first = candidates.begin(); first != candidates.end();) {
      const std::size_t take = first->take;
      const auto last =
          std::find_if(first, candidates.end(), [&](const Candidate& c) { return c.take != take; });
      const auto count = last - first;
      plans[take] = cheapest_plan(takes[take].frames(), segments[take], {cost, cost + count});
      cost += count;
      first = last;
    }
  }
  return plans;
}

}  // namespace moclean
