#include "moclean/segment/spans.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

// Frames that span s shares with the one before it.
Index shared_before(std::span<const Span> spans, std::size_t s) {
  return s == 0 ? 0 : spans[s - 1].last - spans[s].first;
}

void require_segments(const SegmentBatch& batch, std::span<const Span> spans, Index first_segment) {
  const auto count = static_cast<Index>(spans.size());
  if (first_segment < 0 || first_segment + count > batch.segments())
    throw ShapeError(fmt::format("segments {} to {} of a batch of {}", first_segment,
                                 first_segment + count, batch.segments()));
  for (Index s = 0; s < count; ++s) {
    const Index expected = spans[static_cast<std::size_t>(s)].frames();
    const Index rows = batch.rows(first_segment + s);
    if (rows != expected)
      throw ShapeError(fmt::format("segment {} of a batch has {} frames, its span {}",
                                   first_segment + s, rows, expected));
  }
}

}  // namespace

Spans overlapping_spans(const SegmentPlan& plan, Index overlap) {
  if (overlap < 0) throw ArgumentError(fmt::format("overlap is {}, expected at least 0", overlap));
  Spans spans;
  for (std::size_t s = 0; s + 1 < plan.size(); ++s) spans.push_back({plan[s], plan[s + 1]});
  for (std::size_t s = 1; s + 1 < plan.size(); ++s) {
    const Index shorter = std::min(plan[s] - plan[s - 1], plan[s + 1] - plan[s]);
    const Index shared = std::min(overlap, shorter);
    spans[s].first -= shared / 2;
    spans[s - 1].last += shared - shared / 2;
  }
  return spans;
}

double blend_weight(Index k, Index n) {
  const double place = static_cast<double>(k + 1) / static_cast<double>(n + 1);
  return (1 - std::cos(std::numbers::pi * place)) / 2;
}

std::vector<double> blend_weights(std::span<const Span> spans, std::size_t s) {
  std::vector<double> weights(static_cast<std::size_t>(spans[s].frames()), 1.0);
  const Index before = shared_before(spans, s);
  for (Index k = 0; k < before; ++k) weights[static_cast<std::size_t>(k)] = blend_weight(k, before);
  const Index after = s + 1 < spans.size() ? shared_before(spans, s + 1) : 0;
  for (Index k = 0; k < after; ++k)
    weights[static_cast<std::size_t>(spans[s].frames() - after + k)] = 1 - blend_weight(k, after);
  return weights;
}

void stack_spans(const Matrix& samples, std::span<const Span> spans, SegmentBatch& batch,
                 Index first_segment) {
  require_segments(batch, spans, first_segment);
  if (samples.cols() != batch.columns())
    throw ShapeError(fmt::format("a take of {} columns does not fit a batch of {}", samples.cols(),
                                 batch.columns()));
  if (!spans.empty() && spans.back().last != samples.rows())
    throw ShapeError(
        fmt::format("spans of {} frames for a take of {}", spans.back().last, samples.rows()));
  for (const Span& span : spans)
    batch.segment(first_segment++) = samples.middleRows(span.first, span.frames());
}

Matrix blend_spans(const SegmentBatch& batch, std::span<const Span> spans, Index first_segment) {
  require_segments(batch, spans, first_segment);
  Matrix take(spans.empty() ? 0 : spans.back().last, batch.columns());
  for (std::size_t s = 0; s < spans.size(); ++s) {
    const auto later = batch.segment(first_segment + static_cast<Index>(s));
    const Index shared = shared_before(spans, s);
    for (Index k = 0; k < shared; ++k) {
      auto frame = take.row(spans[s].first + k);
      frame += blend_weight(k, shared) * (later.row(k) - frame);
    }
    take.middleRows(spans[s].first + shared, spans[s].frames() - shared) =
        later.bottomRows(spans[s].frames() - shared);
  }
  return take;
}

}  // namespace moclean
