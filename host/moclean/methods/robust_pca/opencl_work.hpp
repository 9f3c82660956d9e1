#pragma once

#include <vector>

#include "moclean/linalg/work.hpp"
#include "moclean/methods/robust_pca/opencl_memory.hpp"

namespace moclean::opencl {

/// How a sweep finds A: XW, (XV) diag(f) V', or WX of a wide segment.
enum class LowRankPart { full, low_rank, wide };

/// Work of kernels/robust_pca/sweep.cl on the active segments in the given states; `real` is the
/// size of an entry of X in bytes.
///   sweep    of the segments whose A is found so: A = XW (4 rows columns rank flops at low rank),
///            12 flops per entry, and the Gram matrix of X+ if it is fused; reads D, X, Y and
///            writes Y+, X+
///   shrink   the same without products, from A
Work sweep_work(const Batch& batch, const std::vector<SegmentState>& states, LowRankPart of,
                bool with_gram, std::size_t real);
Work shrink_work(const Batch& batch, const std::vector<SegmentState>& states, std::size_t real);

/// Gram matrices of the segments that are not wide, from entries of `real` bytes.
Work tall_gram_work(const Batch& batch, std::size_t real);

}  // namespace moclean::opencl
