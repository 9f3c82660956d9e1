#pragma once

#include <span>
#include <vector>

#include "moclean/core/segment_batch.hpp"
#include "moclean/segment/plan.hpp"

namespace moclean {

/// Frames first .. last - 1 of a take: a segment that may share frames with its neighbours.
struct Span {
  Index first = 0;
  Index last = 0;

  Index frames() const { return last - first; }
  bool operator==(const Span&) const = default;
};

/// The spans of one take: the first begins at frame 0, the last ends with the take; each begins
/// after the one before, but no later than that one ends, and ends no earlier than it. No frame
/// belongs to more than two.
using Spans = std::vector<Span>;

/// The segments of a plan, widened so that neighbours share `overlap` frames around their boundary:
/// floor(overlap / 2) before it, the others after it. Where a neighbour is shorter than `overlap`,
/// they share only so many frames as the shorter one has. Without overlap: the segments themselves.
/// Throws ArgumentError if overlap is negative.
Spans overlapping_spans(const SegmentPlan& plan, Index overlap);

/// Weight of the later of two spans at frame k of the n they share, 0 <= k < n: the raised cosine
/// (1 - cos(pi (k + 1) / (n + 1))) / 2, which leaves 0 and reaches 1 without slope. The earlier one
/// has 1 minus it. Two results that are d apart add to each second difference (pi / n)^2 d / 2 at
/// most; a cut adds d.
double blend_weight(Index k, Index n);

/// Weights of one span's frames, [spans[s].frames()]; those of all spans sum to 1 at every frame.
std::vector<double> blend_weights(std::span<const Span> spans, std::size_t s);

/// Copies the spans of a take one below the other into segments first_segment, first_segment + 1
/// and so on of `batch`; shared frames are in it twice. `samples` is [frames x columns]. Throws
/// ShapeError if the segments are not as long as the spans, or not as wide as the samples.
void stack_spans(const Matrix& samples, std::span<const Span> spans, SegmentBatch& batch,
                 Index first_segment = 0);

/// The way back: one take [frames x columns] out of the segments of its spans. Shared frames are
/// a + w (b - a) of the earlier a and the later b, so that equal ones stay as they are, bit for
/// bit; NaN in either is NaN. Throws ShapeError as stack_spans().
Matrix blend_spans(const SegmentBatch& batch, std::span<const Span> spans, Index first_segment = 0);

}  // namespace moclean
