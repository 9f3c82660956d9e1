#include "moclean/backend/backend.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/usable.hpp"

namespace moclean {
namespace {

void require_entries(const SegmentBatch& data, bool missing_accepted) {
  for (Index b = 0; b < data.segments(); ++b) {
    const ConstMatrixView segment = data.segment(b);
    const auto place = first_unusable(segment, missing_accepted, largest_entry);
    if (!place) continue;
    const auto [i, j] = *place;
    if (std::isfinite(segment(i, j)))
      throw ShapeError(
          fmt::format("segment {}: {} at row {}, column {} is too large (at most {} in magnitude)",
                      b, segment(i, j), i, j, largest_entry));
    throw ShapeError(
        fmt::format("segment {}: not finite at row {}, column {}{}", b, i, j,
                    missing_accepted ? "" : " (missing samples are not supported by this method)"));
  }
}

}  // namespace

Monitor part_of(const Monitor& whole, const Progress& before) {
  Monitor part{.stop = whole.stop};
  if (whole.report)
    part.report = [&](const Progress& own) {
      whole.report({.finished = before.finished + own.finished, .total = before.total});
    };
  return part;
}

void FinishedCount::operator()(Index more) {
  const std::lock_guard lock(reporting_);
  progress_.finished += more;
  if (monitor_.report) monitor_.report(progress_);
}

Solution room_for_solution(const SegmentBatch& data, const Method& method) {
  Solution solution{SegmentBatch(data.columns(), data.first_rows()),
                    SegmentBatch(data.columns(), data.first_rows()),
                    std::vector<SegmentOutcome>(static_cast<std::size_t>(data.segments()))};
  if (tells_trust(method)) {
    solution.trusted.emplace(data.columns(), data.first_rows());
    solution.deviation.emplace(data.columns(), data.first_rows());
  }
  return solution;
}

void require_finite(const SegmentBatch& data) { require_entries(data, false); }

void require_usable(const Problem& problem, const Method& method) {
  const auto priors = static_cast<Index>(problem.priors.size());
  if (priors > 0 && !takes_prior(method))
    throw ArgumentError("priors are not supported by this method");
  if (priors > 0 && priors != problem.data.segments())
    throw ArgumentError(fmt::format("{} priors for {} segments, expected one for each", priors,
                                    problem.data.segments()));
  require_entries(problem.data, accepts_missing(method));
}

}  // namespace moclean
