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
Mask trusted_samples(const Clip& take, const Denoised& result);

/// The status of every sample as its number, 0 to 3, named like the take. Throws as above.
Clip sample_status(const Clip& take, const Denoised& result);

/// How many samples of a clip of sample_status() have each status, in the order of the numbers.
std::array<Index, 4> count_status(const Clip& status);

/// Takes back what was filled in gaps longer than `seconds`: NaN in the motion and in sigma.
/// A joint's gap is a run of frames in each of which it lacks a channel; a column of no joint has
/// its own. The channels of such a frame that were observed stay. Throws ArgumentError for a take
/// without frame rate or a negative time, ShapeError as above.
void leave_long_gaps(const Clip& take, double seconds, Denoised& result);

/// Puts trusted samples back as they were observed, and 0 into their outliers. Throws ShapeError as
/// above.
void keep_observed(const Clip& take, Denoised& result);

}  // namespace moclean
