#pragma once

#include "moclean/body/rigid_edges.hpp"

namespace moclean {

/// Limbs that leave as a whole and come back, all lengths right, [frames x joints]: a joint's first
/// difference jumps by more than 8 times its local scale plus half the local speed plus 10 % of the
/// body's size, and within 0.05 to 2 seconds another jump takes back all but 35 % of it. A limb is
/// two joints at least: flags without a flagged joint at the other end of a hard edge are dropped.
/// Only samples of `trusted` [frames x joints] are looked at, others are interpolated.
Mask jump_flags(const BodyTake& take, const Mask& trusted, const RigidBody& body, double size);

}  // namespace moclean
