#pragma once

#include <vector>

#include "moclean/body/gaps.hpp"
#include "moclean/body/local_frame.hpp"

namespace moclean {

/// Where neighbours carry the joint of a gap, [frames x 3]: from each edge as a rigid body would
/// that moves as they do, the two blended linearly; from one edge alone at the ends of a take. The
/// neighbours, at least three, must be seen at the edges and in `frames`.
Matrix rigid_gap_fill(const BodyTake& take, const Neighbours& neighbours, const Gap& gap,
                      const Frames& frames);

/// On the line between the edges of a gap, or standing still at its one edge, [frames x 3].
Matrix held(const BodyTake& take, const Gap& gap, const Frames& frames);

}  // namespace moclean
