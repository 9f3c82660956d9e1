#pragma once

#include <array>

#include "moclean/denoise/denoiser.hpp"

namespace moclean {

/// What became of one sample of a take.
enum class SampleStatus {
  kept = 0,       ///< observed and trusted
  corrected = 1,  ///< observed, and another value is in the result
  filled = 2,     ///< not observed, and a value is in the result
  missing = 3     ///< no value in the result
};

inline constexpr std::array sample_status_names = {"kept", "corrected", "filled", "missing"};

/// Which observed samples the method left as they were: those it says it trusted
/// (Denoised::trusted), else those with |outlier| <= sigma where it has a sigma and outlier = 0
/// where it has none. Robust PCA has outliers of exactly 0; what a filter changes in the last digit
/// is changed. [frames x columns]. Throws ShapeError if take and result differ in shape.
Mask trusted_samples(const Recording& take, const Denoised& result);

/// Samples of each SampleStatus, in the order of their numbers.
using StatusCounts = std::array<Index, 4>;

/// Counts them. `trusted` is that of trusted_samples().
StatusCounts count_status(const Recording& take, const Denoised& result, const Mask& trusted);

/// The status of every sample as its number, 0 to 3, to be written.
Matrix status_numbers(const Recording& take, const Denoised& result, const Mask& trusted);

/// Takes back what was filled in gaps longer than `seconds`: NaN in the motion and in sigma.
/// A joint's gap is a run of frames in each of which it lacks a channel; a column of no joint has
/// its own. The channels of such a frame that were observed stay. Throws ArgumentError for a take
/// without frame rate or a negative time, ShapeError as above.
void leave_long_gaps(const Recording& take, double seconds, Denoised& result);

/// Puts trusted samples back as they were observed, and 0 into their outliers. They are as trusted
/// afterwards as before.
void keep_observed(const Recording& take, const Mask& trusted, Denoised& result);

}  // namespace moclean
