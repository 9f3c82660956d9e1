#pragma once

#include <cmath>

namespace moclean {

/// What may be said of a rate, in Hz: of what moves, from a frame in ten days to a million in a
/// second.
inline constexpr double least_frame_rate = 1e-6, most_frame_rate = 1e6;

/// Frames per second from seconds per frame, which files print with few digits.
///
/// 1 / seconds, rounded to a whole number when that is within 5e-4 of it: .0083333 means 120 Hz and
/// .03333 means 30 Hz, while the NTSC rates 29.97 and 23.976, 1e-3 off, stay what they are.
inline double rate_from_period(double seconds) {
  const double rate = 1 / seconds;
  const double whole = std::round(rate);
  return std::abs(rate - whole) <= 5e-4 * whole ? whole : rate;
}

}  // namespace moclean
