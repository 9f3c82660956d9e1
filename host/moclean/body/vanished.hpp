#pragma once

#include "moclean/body/body_take.hpp"

namespace moclean {

/// Joints that are reported at the origin because they were lost, [frames x joints]: at exactly
/// 0, 0, 0, or in a cluster there that an empty shell sets apart (zeros under noise).
///
/// The cluster is the smallest radius r, in half octaves from 2^-10 to a third of the median
/// distance from the origin, for which more than half of the joints have 2 to 70 % of their samples
/// within r and fewer than 5 % as many between r and 2 r; it reaches to 1.4 r. Motion does not show
/// that, mean-centred or relative to its root neither: no take of the CMU and HDM05 collections
/// that was tried does.
Mask vanished(const BodyTake& take);

}  // namespace moclean
