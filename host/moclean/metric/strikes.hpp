#pragma once

#include "moclean/motion/recording.hpp"

namespace moclean {

/// What is left of the hardest impacts, such as the strikes of feet: the mean, over the ten largest
/// accelerations of joints in the truth, of the acceleration of the estimate at that sample over
/// that of the truth, both as Euclidean norms of second differences. Peaks of one joint are at
/// least 0.1 s apart. 1 if nothing was changed; below, if impacts were smoothed; noise raises it.
/// Peaks that the estimate leaves missing, and those of size zero, take part in neither sum nor
/// number; NaN where nothing is left. Needs the truth's frame rate: NaN without. Throws ShapeError
/// for clips of different shapes.
double strikes_kept(const Recording& truth, const Recording& estimate);

}  // namespace moclean
