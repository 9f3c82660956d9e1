#include "moclean/methods/robust_pca/opencl_work.hpp"

namespace moclean::opencl {
namespace {

// X, Y+, T and X+ of order ae (kernels/robust_pca/entry.cl); about the same for order ea.
constexpr double flops_per_entry = 20;

// D, T read and written; order ea has A, too.
Work elementwise_work(const SegmentRecord& segment, const SegmentState& state, double real) {
  const double entries = double(segment.rows) * segment.columns;
  return {.flops = flops_per_entry * entries, .bytes = (state.order_ea ? 5 : 3) * entries * real};
}

LowRankPart low_rank_part(const SegmentRecord& segment, const SegmentState& state) {
  if (segment.wide()) return LowRankPart::wide;
  return state.low_rank ? LowRankPart::low_rank : LowRankPart::full;
}

Work product_work(const SegmentRecord& segment, const SegmentState& state, double real) {
  const double entries = double(segment.rows) * segment.columns, order = segment.order;
  if (state.low_rank)
    return {.flops = 4 * entries * state.rank, .bytes = 2 * order * state.rank * real};
  return {.flops = 2 * entries * order, .bytes = order * order * real};
}

}  // namespace

Work sweep_work(const Batch& batch, const std::vector<SegmentState>& states, LowRankPart of,
                bool with_gram, std::size_t real) {
  const auto size = static_cast<double>(real);
  return total_work(batch, [&](std::size_t b, const SegmentRecord& segment) {
    if (states[b].finished || low_rank_part(segment, states[b]) != of) return Work{};
    Work work = elementwise_work(segment, states[b], size);
    work += product_work(segment, states[b], size);
    if (with_gram && !segment.wide()) {
      const Work gram = gram_work(segment);
      const double rows = double(segment.rows) * segment.columns * sizeof(double);
      work += {.flops = gram.flops, .bytes = gram.bytes - rows};  // X+ is at hand
    }
    return work;
  });
}

Work shrink_work(const Batch& batch, const std::vector<SegmentState>& states, std::size_t real) {
  return total_work(batch, [&](std::size_t b, const SegmentRecord& segment) {
    if (states[b].finished) return Work{};
    return elementwise_work(segment, states[b], static_cast<double>(real));
  });
}

Work tall_gram_work(const Batch& batch, std::size_t real) {
  return total_work(batch, [&](std::size_t, const SegmentRecord& segment) {
    return segment.wide() ? Work{} : gram_work(segment, real);
  });
}

}  // namespace moclean::opencl
