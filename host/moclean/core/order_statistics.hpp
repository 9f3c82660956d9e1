#pragma once

#include <span>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// A normal distribution's standard deviation over its median absolute deviation.
inline constexpr double deviation_per_mad = 1.4826;

/// The q-quantile, 0 <= q <= 1, between the two nearest order statistics by linear interpolation
/// (Hyndman, Fan 1996, type 7). Reorders the values, of which there is at least one and no NaN.
double quantile(std::span<double> values, double q);

/// quantile(values, 0.5).
double median(std::span<double> values);

/// Puts the median of the samples around it, `window` (odd) of them, in the place of every sample;
/// the window shrinks at both ends. No sample is NaN.
void running_median(std::span<double> samples, Index window);

}  // namespace moclean
