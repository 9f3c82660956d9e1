#pragma once

#include <span>

#include "moclean/body/rigid_edges.hpp"
#include "moclean/body/sudden_steps.hpp"

namespace moclean {

/// Limbs that leave as a whole and come back, all lengths right, [frames x joints]: a joint has a
/// sudden step, and within 0.05 to 2 seconds another takes back all but 35 % of it. A limb is two
/// joints at least: flags without a flagged joint at the other end of a hard edge are dropped.
/// `steps` is [joints].
Mask jump_flags(const BodyTake& take, std::span<const SuddenSteps> steps, const RigidBody& body);

}  // namespace moclean
