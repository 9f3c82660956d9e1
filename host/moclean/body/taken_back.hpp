#pragma once

#include "moclean/body/edge_distances.hpp"

namespace moclean {

/// Takes back flags `bad` [frames x joints] of joints that turned about another: an exact distance
/// to a joint not voted out held for 0.9 of a run of 0.04 s or more. Returns the samples whose
/// distance is that to the last digit on average: those are right.
Mask take_back_turning(const BodyTake& take, const RigidBody& body, const EdgeDistances& d,
                       const EdgeLimits& limits, Mask& bad);

/// What the hard distances of joints say where noise hides which of them are exact: the one that is
/// off least often stands for a joint's bone.
struct NoisyBones {
  Matrix off;      ///< of the bone, [frames x joints], deviations of noise; NaN: nothing known
  Matrix largest;  ///< of any hard distance of the joint, as `off`; 0 where nothing is known
  Eigen::Array<double, 1, Eigen::Dynamic> noise;    ///< [joints]: deviation of the bone's length
  Eigen::Array<double, 1, Eigen::Dynamic> chances;  ///< [joints]: hard distances to choose from

  bool empty() const { return off.size() == 0; }
};

/// Without what is voted `out` [frames x joints]. Empty where a distance is exact.
NoisyBones noisy_bones(const RigidBody& body, const EdgeDistances& d, const EdgeLimits& limits,
                       const Mask& out);

/// The runs of marked samples [frames x joints], `displaced` by so many deviations of noise, in
/// which the bone is right up to the noise of the run's average, which chance would hardly do.
/// It does to some of many gross errors: none unless these are 0.4 of the marked samples.
Mask turning_in_noise(const Mask& runs, const NoisyBones& bones, const Matrix& displaced);

/// Takes back flags of runs of joints that no exact distance accuses and that neither leave nor
/// come back by a jump: a distance that is steady for a while changes gradually when the pose does.
/// `noise` is the deviation of a coordinate.
void take_back_gradual(const BodyTake& take, const RigidBody& body, const EdgeDistances& d,
                       const EdgeLimits& limits, double noise, Mask& bad);

}  // namespace moclean
