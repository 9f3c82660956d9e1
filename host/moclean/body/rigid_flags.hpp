#pragma once

#include "moclean/body/rigid_edges.hpp"
#include "moclean/body/taken_back.hpp"

namespace moclean {

/// What the distances between joints say of every joint in every frame, [frames x joints].
struct RigidFlags {
  Mask bad;          ///< wrong: voted out for distances that are off
  Mask confirmed;    ///< right: two rigid distances or more say so and none the contrary, or as
                     ///< vote_on_joints() takes flags back
  Mask consistent;   ///< as confirmed, but one distance is enough where a joint has no more
  NoisyBones bones;  ///< empty where a distance is exact
};

/// Compares the distances of a take with those of its body. In every frame the joint with the
/// largest weighted share of wrong distances is voted out, again and again, as long as
/// that share exceeds 0.4: a knee has two exact distances of equal weight, one of which may be
/// right by coincidence. An exact distance counts 1.6 times: alone it is not outvoted by another
/// one, such as that of a limb that is straight for most of a take. Where dense noise hides small
/// errors, lasting ones are looked for in running medians of the distances, too.
///
/// Flags of joints that turned, or moved gradually, are taken back (taken_back.hpp). `size` is
/// body_size(take). `noise_is_white`: otherwise neighbouring frames share it, an average over a run
/// has about as much as a frame, and there are no NoisyBones.
RigidFlags vote_on_joints(const BodyTake& take, const RigidBody& body, double size, double smallest,
                          bool noise_is_white = true);

}  // namespace moclean
