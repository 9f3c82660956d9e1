#pragma once

#include <span>

#include "moclean/motion/recording.hpp"

namespace moclean {

// Errors of a motion as a whole. f frames, d columns; a joint is one of joints(clip), a channel
// that stands alone counts as a joint of one dimension. What needs a sample that is NaN takes part
// in neither sum nor size; where nothing is left, the figure is NaN. Clips of different shapes
// throw ShapeError. Lengths are in the clips' unit.
//
// Li 2022: Li, Zhu, Wang, Liu, "Dual auto-encoder network for human skeleton motion data
// optimization", 2022. Its |.|_2 of a matrix is taken as the root of the sum of squares.

/// Mean Euclidean distance of a joint from where it was, over all frames and joints.
double position_error(const Recording& truth, const Recording& estimate);

/// Largest Euclidean distance of a joint from where it was, over all frames and joints.
double worst_displacement(const Recording& truth, const Recording& estimate);

/// Position error as printed in Li 2022, equation (11): |estimate - truth|_2 / (f d). Falls with
/// 1/sqrt(f d) for errors of equal size, so it compares clips of equal shape only.
double li_position_error(const Recording& truth, const Recording& estimate);

/// Bone-length error of Li 2022, equation (13): the mean over frames and bones of
/// | |p - p_parent| - l |, l being the bone's mean length in the truth. `parents` holds for each
/// joint of joints(truth) the index of the joint it hangs on, -1 for a root; only joints of three
/// columns have bones. Throws ShapeError if there are not as many parents as joints.
double bone_length_error(const Recording& truth, const Recording& estimate,
                         std::span<const int> parents);

/// Smoothness error of Li 2022, equations (14) and (15), of one clip: |O Y'|_2 / ((f + 2) d), Y'
/// being the clip with its first and last frame repeated once and O Y' its second differences, the
/// first and the last row of which are zero. The unit is that of lengths, per frame squared. It is
/// no distance from a truth: noise raises it, and so does quick motion.
double smoothness_error(const Recording& clip);

/// Mean Euclidean norm, over joints and inner frames, of the second difference of estimate - truth
/// (as Kanazawa et al. 2019 measure jitter). In lengths per frame squared: times the frame rate
/// squared it is per second squared.
double acceleration_error(const Recording& truth, const Recording& estimate);

}  // namespace moclean
