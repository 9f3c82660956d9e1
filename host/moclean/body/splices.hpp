#pragma once

#include <span>
#include <vector>

#include "moclean/body/rigid_edges.hpp"
#include "moclean/body/sudden_steps.hpp"

namespace moclean {

/// Frames at which another motion begins, ascending: the body is whole on both sides, but a third
/// of it has moved as no body moves, and does not come back. The T-pose in frame 0 of many BVH
/// files ends like that, and so do takes that were joined. Nothing on one side tells of the other.
///
/// In a step, or a run of neighbouring ones, 30 % of the joints with a hard edge take sudden steps
/// that `jumps`, the jump_flags(), do not explain; before and after it 80 % of those joints are
/// `trusted` [frames x joints]. `steps` is [joints].
std::vector<Index> splices(const Mask& trusted, std::span<const SuddenSteps> steps,
                           const RigidBody& body, const Mask& jumps);

}  // namespace moclean
