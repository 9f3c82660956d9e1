#pragma once

#include <vector>

#include "moclean/body/body_take.hpp"

namespace moclean {

using Frames = std::vector<Index>;

/// Frames [first, last) in which a joint is not seen; `before` and `after`: whether there is a
/// frame first - 1, a frame last, its edges.
struct Gap {
  Index joint = 0, first = 0, last = 0;
  bool before = true, after = true;

  Index frames() const { return last - first; }
};

/// The gaps of a take of at least `least` frames and with an edge, joint by joint.
std::vector<Gap> gaps_of(const BodyTake& take, Index least);

/// Place of a frame in a gap: above 0 at the first edge, below 1 at the last; in a gap of one edge
/// how far it is from that, 1 at the end.
double place(const Gap& gap, Index frame);

/// The edges of a gap: one or two frames, in order.
Frames edges(const Gap& gap);

/// `count` frames of a gap, evenly, symmetric about its middle.
Frames probes(const Gap& gap, Index count);

/// Up to `most` gaps like this one but `frames` long at evenly spread places where edges and
/// `probed` probes all lie in frames that are `usable`.
std::vector<Gap> trials(const Gap& gap, Index frames, Index probed, std::size_t most,
                        const std::vector<bool>& usable);

}  // namespace moclean
