#include "moclean/denoise/low_rank.hpp"

#include <chrono>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/parallel.hpp"
#include "moclean/denoise/cheapest_plans.hpp"
#include "moclean/denoise/unobserved.hpp"

namespace moclean {
namespace {

// Takes of equal width, whose segments share one batch.
struct Stack {
  std::vector<std::size_t> takes;
  std::vector<Index> first_segments;  // of the takes
  SegmentBatch data;
};

Stack stack(std::span<const Recording> takes, std::vector<std::size_t> members,
            std::span<const Spans> spans) {
  std::vector<Index> first_row = {0}, first_segments;
  for (const std::size_t t : members) {
    first_segments.push_back(static_cast<Index>(first_row.size()) - 1);
    for (const Span& span : spans[t]) first_row.push_back(first_row.back() + span.frames());
  }
  SegmentBatch data(takes[members.front()].samples.cols(), std::move(first_row));
  for (std::size_t i = 0; i < members.size(); ++i)
    stack_spans(takes[members[i]].samples, spans[members[i]], data, first_segments[i]);
  return {std::move(members), std::move(first_segments), std::move(data)};
}

// Takes of equal width together, in increasing width.
std::vector<Stack> stacks_by_width(std::span<const Recording> takes, std::span<const Spans> spans) {
  std::map<Index, std::vector<std::size_t>> by_width;
  for (std::size_t t = 0; t < takes.size(); ++t) by_width[takes[t].samples.cols()].push_back(t);
  std::vector<Stack> stacks;
  for (auto& [width, members] : by_width) stacks.push_back(stack(takes, std::move(members), spans));
  return stacks;
}

// Automatic segments are compared by robust PCA, whatever the method: by its own if it is that.
std::vector<SegmentPlan> plans_of(std::span<const Recording> takes,
                                  const Segmentation& segmentation, const Method& method,
                                  Backend& backend, const std::stop_token& stop) {
  std::vector<SegmentPlan> equal;
  for (const Recording& take : takes) equal.push_back(plan(segmentation, take.frames()));
  if (!segmentation.cheapest) return equal;
  std::vector<Index> counts;
  for (const SegmentPlan& one : equal) counts.push_back(static_cast<Index>(one.size()) - 1);
  const auto* robust_pca = std::get_if<RobustPca>(&method);
  return cheapest_plans(takes, counts, robust_pca ? *robust_pca : RobustPca{}, backend, stop);
}

void scatter(const Stack& stacked, const Solution& solution, double seconds, int jobs,
             std::span<const Recording> takes, std::span<const Spans> spans,
             std::vector<Denoised>& results) {
  for_each_index(static_cast<Index>(stacked.takes.size()), jobs, [&](Index i) {
    const std::size_t t = stacked.takes[static_cast<std::size_t>(i)];
    const Index segment = stacked.first_segments[static_cast<std::size_t>(i)];
    auto outcome = solution.segments.begin() + segment;
    Denoised& result = results[t];
    result.motion = blend_spans(solution.low_rank, spans[t], segment);
    result.outliers = blend_spans(solution.sparse, spans[t], segment);
    leave_unobserved(takes[t], result);
    Index rows = 0;
    for (const Span& span : spans[t]) {
      result.segments.push_back({span.first, span.frames(), *outcome++});
      rows += span.frames();
    }
    result.solve_seconds =
        seconds * static_cast<double>(rows) / static_cast<double>(stacked.data.rows());
  });
}

}  // namespace

SegmentPlan plan(const Segmentation& segmentation, Index frames) {
  if (segmentation.whole) return equal_segments(frames, 1);
  if (segmentation.segments != 0) return equal_segments(frames, segmentation.segments);
  return segments_of_length(frames, segmentation.length);
}

// The stacked data, A and E beside the results, and padding of the rows. Segments that overlap are
// stacked and solved at twice their length at most.
std::uint64_t copies_held(const Segmentation& segmentation) {
  constexpr std::uint64_t stacked = 1, solved = 2, padding = 1, overlapping = 4;
  std::uint64_t copies = stacked + solved + copies_in_result + padding;
  if (segmentation.overlap > 0) copies += overlapping;
  if (segmentation.cheapest) copies += copies_held_by_plans;
  return copies;
}

std::string too_small(const Matrix& samples, std::string_view name) {
  constexpr double least = 1e-140;
  const double most = samples.array().isNaN().select(0, samples).cwiseAbs().maxCoeff();
  if (most == 0 || most >= least) return {};
  return fmt::format(
      "has no sample larger than {:.3g}; {} needs some of {} at least: state them in another unit",
      most, name, least);
}

std::vector<Denoised> LowRankDenoiser::denoise(std::span<const Recording> takes,
                                               const Monitor& monitor) {
  require_usable(takes, accepts_missing(method_));
  for (std::size_t t = 0; t < takes.size(); ++t)
    if (const std::string why = too_small(takes[t].samples, "this method"); !why.empty())
      throw TakeError(t, why);
  std::vector<Spans> spans;
  for (const SegmentPlan& one : plans_of(takes, segmentation_, method_, backend_, monitor.stop))
    spans.push_back(overlapping_spans(one, segmentation_.overlap));
  const std::vector<Stack> stacks = stacks_by_width(takes, spans);
  Progress all;
  for (const Stack& stacked : stacks) all.total += stacked.data.segments();

  std::vector<Denoised> results(takes.size());
  for (const Stack& stacked : stacks) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    const Solution solution = backend_.solve(stacked.data, method_, part_of(monitor, all));
    const std::chrono::duration<double> seconds = Clock::now() - begin;
    scatter(stacked, solution, seconds.count(), jobs_, takes, spans, results);
    all.finished += stacked.data.segments();
  }
  return results;
}

}  // namespace moclean
