#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "moclean/filter/butterworth.hpp"
#include "moclean/filter/gcv_spline.hpp"
#include "moclean/filter/interpolate.hpp"
#include "moclean/filter/kalman.hpp"
#include "moclean/filter/no_filter.hpp"
#include "moclean/filter/savitzky_golay.hpp"
#include "moclean/filter/whittaker.hpp"
#include "moclean/filter/window.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Every filter there is. Each works on one channel at a time; what it does at the ends of a take
/// and beside gaps stands in its own comment. A sample that is NaN stays NaN unless fills_gaps().
using Filter =
    std::variant<MovingAverage, GaussianFilter, MedianFilter, Hampel, Butterworth, SavitzkyGolay,
                 Whittaker, RobustWhittaker, GcvSpline, KalmanSmoother, Interpolate, NoFilter>;

/// Whether a filter's parameters are in Hz or per second.
template <class F>
inline constexpr bool has_frame_rate = requires {
  F::needs_frame_rate;
};
bool needs_frame_rate(const Filter& filter);

/// Whether a filter leaves no sample missing but in channels without any.
bool fills_gaps(const Filter& filter);

/// What its specifications begin with.
std::string_view name_of(const Filter& filter);

/// The specification it is read from, with every parameter.
std::string to_string(const Filter& filter);

/// Every column of a take filtered, on up to `jobs` threads; the result does not depend on them.
/// Throws ArgumentError for parameters out of range, and for a take without a frame rate if the
/// filter needs one.
Matrix filtered(const Recording& take, const Filter& filter, int jobs = 1);

}  // namespace moclean
