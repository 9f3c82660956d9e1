#pragma once

#include <numbers>
#include <vector>

#include "moclean/core/matrix.hpp"
#include "moclean/motion/recording.hpp"
#include "moclean/motion/skeleton.hpp"

namespace moclean {

/// What counts as a spike in the channels of a skeleton.
struct RotationSpikes {
  double least_turn = 3.5 * std::numbers::pi / 180;  ///< radians between a rotation and its
                                                     ///< neighbours' that can be a spike
  double least_shift = 0.01;  ///< likewise of translations, as a share of the body's size
  double ratio = 10;          ///< to what is usual around it
  Index longest = 2;          ///< frames
  Index around = 20;          ///< frames before and after, that say what is usual
};

/// One that was taken out.
struct RotationSpike {
  std::size_t bone = 0;
  Index first = 0, frames = 0;
  bool is_turn = true;  ///< of the rotation channels, else of the translations
  double size = 0;      ///< radians, or in the file's unit
};

/// Replaces spikes in channels [frames x skeleton.channels()] by what lies between their
/// neighbours, and says which; all other channels keep their bits.
///
/// Damage in one channel of a file moves a whole limb, which positions tell little of: so rotations
/// are looked at as such, joint by joint. A run of up to `longest` frames is a spike if its
/// rotation is farther from that which the two frames before and after it make probable (cubic, and
/// linear) than `ratio` times what is usual around it, than `least_turn`, and than what is between
/// those before and those after but for their velocities, so that a step is none; and if the joints
/// below move more smoothly without it (a turn that the next joint takes back moves nothing). Runs
/// at either end of the take, with fewer than two frames beside them, stay.
///
/// New angles are those nearest to their neighbours'. Frames with a missing channel stay.
std::vector<RotationSpike> take_out_spikes(const Skeleton& skeleton, Matrix& channels,
                                           const RotationSpikes& parameters = {});

/// take_out_spikes() of the channels of a recording. In frames where it found some the samples
/// become the positions that the channels make; a warning says how many and which is the largest.
/// False for a recording without channels, which it leaves alone.
bool clean_rotations(Recording& recording, const RotationSpikes& parameters = {});

}  // namespace moclean
