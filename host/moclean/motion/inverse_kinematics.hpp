#pragma once

#include "moclean/core/matrix.hpp"
#include "moclean/motion/skeleton.hpp"

namespace moclean {

/// Channels that bring the joints of a skeleton as near to given positions as its bones allow: the
/// way back from forward_kinematics().
///
/// `channels` [frames x skeleton.channels()] is where the search of every frame begins, and what
/// decides wherever positions cannot: the turn of a bone about itself, joints that end a limb, the
/// number of whole turns of an angle. `positions` is [frames x 3 bones], in the skeleton's unit;
/// NaN was not observed. Bone lengths are exact: of the translations only those of roots change.
///
/// Per frame and joint first the best rotation to the directions of its children (Kabsch 1976; with
/// one child the shortest arc), applied to the rotation by `channels`; then Gauss-Newton steps with
/// Levenberg's damping for the sum of squared distances over all joints. A step costs a few 3 x 3
/// products per bone: the costs of a limb are a quadratic form in the motion of its base, found
/// from the tips inwards (as in Featherstone 1987, The Articulated-Body Algorithm). A joint with
/// three rotations about different axes turns freely, one with others about its axes alone.
///
/// A joint keeps its channels, to the bit, if its position, those of its children and those of its
/// ancestors are (to 1e-9 of the body's size) what `channels` makes them, or NaN; a frame where
/// that is true of all joints is kept whole. Frames are independent, but for this: where the input
/// was thrown by whole turns and the result need not be, angles follow the frame before, and where
/// rotations still jump the search begins once more, from the frame before.
///
/// A channel that is NaN was not observed: the search begins between its neighbours in time. It
/// becomes a number where a joint that it moves has a position, and is NaN still where none has.
///
/// Throws ShapeError if sizes do not fit.
Matrix inverse_kinematics(const Skeleton& skeleton, const Matrix& channels, const Matrix& positions,
                          int jobs = 1);

}  // namespace moclean
