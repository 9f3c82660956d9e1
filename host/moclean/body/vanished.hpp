#pragma once

#include "moclean/body/body_take.hpp"

namespace moclean {

/// Joints whose seen positions are all exactly the same, [joints]: the static root of a skeleton,
/// the hip of a pose relative to it, a marker of the room. They tell nothing of how a body moves.
/// A joint that is never seen is none.
std::vector<bool> still_joints(const BodyTake& take);

/// Joints that are reported at the origin because they were lost, [frames x joints]: at exactly
/// 0, 0, 0, or in a cluster there that an empty shell sets apart (zeros under noise). A joint that
/// is still is never lost.
///
/// Exact zeros are lost where the joint is elsewhere in at least half of its samples, gets there
/// and leaves by more than twice the largest tenth of its other steps, and is not at its usual
/// distances from two joints or more that stay at a constant distance from it: the root of a pose
/// at the origin is there.
///
/// The cluster is the smallest radius r, in half octaves from 2^-10 to a third of the median
/// distance from the origin, for which more than half of the joints have 2 to 70 % of their samples
/// within r and fewer than 5 % as many between r and 2 r; it reaches to 1.4 r. Motion does not show
/// that, mean-centred or relative to its root neither: no take of the CMU and HDM05 collections
/// that was tried does.
Mask vanished(const BodyTake& take);

}  // namespace moclean
