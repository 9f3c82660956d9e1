#pragma once

#include <cstdint>

#include "moclean/core/segment_batch.hpp"

namespace moclean {

/// Equal segments that cost a solver what motion capture under the noise of Peng et al. does, for
/// measurements without a recording. Columns are sums of eight slow sinusoids of random phase, so
/// that the spectrum falls steeply but never ends; a third of the frames get, in half of their
/// entries, a Gaussian(1, 1.2). At 200 x 93 robust PCA takes 39 iterations and ends at rank 37; CMU
/// 14_06 takes 38 and ends near 58.
SegmentBatch motion_like(Index segments, Index frames, Index columns, std::uint64_t seed = 1);

}  // namespace moclean
