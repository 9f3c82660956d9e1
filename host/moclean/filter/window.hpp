#pragma once

#include <span>
#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

// Filters of a window that is centred on the frame. Samples that are missing or outside the take
// are left out of the window: it shrinks at both ends of a take and beside gaps, and gaps stay
// gaps.

/// Mean of the window.
struct MovingAverage {
  Index window = 7;  ///< frames, odd, at most 9999

  bool operator==(const MovingAverage&) const = default;

  static constexpr std::string_view name = "moving-average";
  static void visit(auto& self, auto& visitor) { visitor("window", self.window); }
};

/// Mean weighted by exp(-t^2 / (2 sd^2)), t frames from the centre, out to four deviations.
struct GaussianFilter {
  double sd = 2;  ///< frames, above 0, at most 1000

  bool operator==(const GaussianFilter&) const = default;

  static constexpr std::string_view name = "gaussian";
  static void visit(auto& self, auto& visitor) { visitor("sd", self.sd); }
};

/// Median of the window; the mean of the two in the middle where it holds an even number of
/// samples.
struct MedianFilter {
  Index window = 7;  ///< frames, odd, at most 9999

  bool operator==(const MedianFilter&) const = default;

  static constexpr std::string_view name = "median";
  static void visit(auto& self, auto& visitor) { visitor("window", self.window); }
};

/// Puts the median m of the window in the place of a sample farther than sigmas * 1.4826 MAD from
/// it, MAD being the window's median of |x - m| (Hampel 1974); leaves all others as they are.
struct Hampel {
  Index window = 7;   ///< frames, odd, at most 9999
  double sigmas = 3;  ///< >= 0

  bool operator==(const Hampel&) const = default;

  static constexpr std::string_view name = "hampel";
  static void visit(auto& self, auto& visitor) {
    visitor("window", self.window);
    visitor("sigmas", self.sigmas);
  }
};

/// Throws ArgumentError for parameters out of range.
void check(const MovingAverage& filter);
void check(const GaussianFilter& filter);
void check(const MedianFilter& filter);
void check(const Hampel& filter);

/// Filters one channel in place.
void smooth(const MovingAverage& filter, double frame_rate, std::span<double> channel);
void smooth(const GaussianFilter& filter, double frame_rate, std::span<double> channel);
void smooth(const MedianFilter& filter, double frame_rate, std::span<double> channel);
void smooth(const Hampel& filter, double frame_rate, std::span<double> channel);

}  // namespace moclean
