#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "moclean/core/random.hpp"
#include "moclean/core/segment_batch.hpp"

namespace moclean::bench {

/// The one home of what is timed: segments that behave like motion capture under the paper's noise.
/// Columns are smooth (sums of eight slow sinusoids of random phase, so the spectrum falls steeply
/// but never ends) and a third of the frames get, in half of their entries, a Gaussian(1, 1.2).
/// At 200 x 93 it takes 39 iterations and ends at rank 37; CMU 14_06 takes 38 and ends near 58.
inline SegmentBatch motion_like(Index segments, Index frames, Index columns,
                                std::uint64_t seed = 1) {
  constexpr int waves = 8;
  std::vector<Index> first_row;
  for (Index b = 0; b <= segments; ++b) first_row.push_back(b * frames);
  SegmentBatch batch(columns, first_row);
  Random random(seed);
  for (Index b = 0; b < segments; ++b) {
    auto segment = batch.segment(b);
    for (Index c = 0; c < columns; ++c) {
      segment.col(c).setConstant(10 * random.normal());
      for (int w = 1; w <= waves; ++w) {
        const double phase = 6.283185307179586 * random.uniform();
        const double size = 2 * random.normal() / w;
        for (Index f = 0; f < frames; ++f)
          segment(f, c) += size * std::sin(0.01 * w * static_cast<double>(f) + phase);
      }
    }
    for (const Index f : random.choose(frames / 3, frames))
      for (Index c = 0; c < columns; ++c)
        if (random.uniform() < 0.5) segment(f, c) += 1 + 1.2 * random.normal();
  }
  return batch;
}

}  // namespace moclean::bench
