#include "moclean/denoise/chain.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "moclean/core/error.hpp"
#include "moclean/denoise/unobserved.hpp"

namespace moclean {
namespace {

// As planned: there may be more where a method cuts takes itself.
Index segments_of(const Step& step, std::span<const Recording> takes) {
  if (std::holds_alternative<Filter>(step)) return 0;
  Index count = 0;
  for (const Recording& take : takes) {
    const auto* low_rank = std::get_if<LowRank>(&step);
    const SegmentPlan segments = low_rank ? plan(low_rank->segmentation, take.frames())
                                          : plan(std::get<Automatic>(step), take.frames());
    count += static_cast<Index>(segments.size()) - 1;
  }
  return count;
}

// What was taken away; 0 where either is missing.
Matrix difference(const Matrix& samples, const Matrix& motion) {
  const Matrix removed = samples - motion;
  return removed.array().isNaN().select(0, removed);
}

}  // namespace

// Filters have fewer than any matrix method. Several steps keep what they began with and what the
// last one made.
std::uint64_t copies_held(const Chain& chain) {
  constexpr std::uint64_t kept_by_steps = 2;
  std::uint64_t most = copies_held(Segmentation{});
  for (const Step& step : chain) {
    if (const auto* low_rank = std::get_if<LowRank>(&step))
      most = std::max(most, copies_held(low_rank->segmentation));
    if (const auto* automatic = std::get_if<Automatic>(&step))
      most = std::max(most, copies_held(*automatic));
  }
  return chain.size() > 1 ? most + kept_by_steps : most;
}

ChainDenoiser::ChainDenoiser(Chain chain, Backend* backend, int jobs)
    : chain_(std::move(chain)), backend_(backend), jobs_(jobs) {
  if (chain_.empty()) throw ArgumentError("a chain needs at least one method");
  if (!backend && needs_backend(chain_))
    throw ArgumentError(name_of(*first_on_backend(chain_)) + " needs a backend");
  for (const Step& step : chain_) {
    if (const auto* low_rank = std::get_if<LowRank>(&step)) backend_->prepare(low_rank->method);
    if (std::holds_alternative<Automatic>(step)) backend_->prepare(MatrixNormal{});
  }
}

std::vector<Denoised> ChainDenoiser::solve(const Step& step, std::span<const Recording> takes,
                                           const Monitor& monitor) {
  if (const auto* automatic = std::get_if<Automatic>(&step))
    return AutomaticDenoiser(*automatic, *backend_, jobs_).denoise(takes, monitor);
  const auto& low_rank = std::get<LowRank>(step);
  return LowRankDenoiser(low_rank.segmentation, low_rank.method, *backend_, jobs_)
      .denoise(takes, monitor);
}

std::vector<Denoised> ChainDenoiser::denoise(std::span<const Recording> takes,
                                             const Monitor& monitor) {
  if (chain_.size() == 1 && needs_backend(chain_)) return solve(chain_.front(), takes, monitor);
  require_usable(takes, accepts_missing(chain_));
  Index finished = 0, planned = 0;  // segments of steps that are done, and of those to come
  for (const Step& step : chain_) planned += segments_of(step, takes);
  Monitor part{.stop = monitor.stop};
  if (monitor.report)
    part.report = [&](const Progress& own) {
      monitor.report(
          {.finished = finished + own.finished, .total = finished + own.total + planned});
    };

  std::vector<Recording> cleaned;  // so far
  for (const Recording& take : takes) {
    cleaned.push_back(like(take, take.samples));
    cleaned.back().confidence = take.confidence;
  }
  std::vector<Denoised> results(takes.size());
  for (const Step& step : chain_) {
    if (monitor.stop.stop_requested()) throw Cancelled();
    const auto* filter = std::get_if<Filter>(&step);
    if (!filter) {
      planned -= segments_of(step, takes);
      auto solved = solve(step, cleaned, part);
      for (std::size_t t = 0; t < cleaned.size(); ++t) {
        finished += static_cast<Index>(solved[t].segments.size());
        cleaned[t].samples = std::move(solved[t].motion);
        results[t].solve_seconds += solved[t].solve_seconds;
        if (results[t].segments.empty()) results[t].segments = std::move(solved[t].segments);
        if (&step == &chain_.back()) results[t].sigma = std::move(solved[t].sigma);
      }
      continue;
    }
    for (std::size_t t = 0; t < cleaned.size(); ++t) {
      const auto begin = std::chrono::steady_clock::now();
      cleaned[t].samples = filtered(cleaned[t], *filter, jobs_);
      results[t].solve_seconds +=
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }
  }
  for (std::size_t t = 0; t < cleaned.size(); ++t) {
    results[t].outliers = difference(takes[t].samples, cleaned[t].samples);
    results[t].unobserved = unobserved_columns(takes[t]);
    results[t].motion = std::move(cleaned[t].samples);
  }
  return results;
}

}  // namespace moclean
