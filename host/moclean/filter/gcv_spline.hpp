#pragma once

#include <span>
#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

/// Natural smoothing spline whose smoothing is chosen by generalised cross-validation, for every
/// channel by itself: the standard smoother of biomechanics (Woltring 1986, "A Fortran package for
/// generalized, cross-validatory spline smoothing and differentiation"; Craven, Wahba 1979).
///
///   minimise  sum (y - s)^2 + p integral (s^(m))^2,  m = (degree + 1) / 2
///
/// over all s, time in frames; the minimiser is a spline of that degree with a knot at every
/// observed sample. With A(p) the matrix that turns the n samples y into s, p minimises
///   (|y - s|^2 / n) / (tr(I - A) / n)^2
/// which estimates the error against the motion if the noise is independent from frame to frame:
/// slow noise is taken for motion, gross errors are not looked for. A slow sinusoid of w radians
/// per frame passes with the gain 1 / (1 + p w^(2 m)); p is such that the gain is 1/2 somewhere
/// between 0.02 (0.4 Hz at 120 Hz) and 10. A gap has no samples, and stays a gap; the ends are
/// free. A channel of fewer than 2 m samples is left as it is.
struct GcvSpline {
  Index degree = 5;  ///< 1, 3 or 5

  bool operator==(const GcvSpline&) const = default;

  static constexpr std::string_view name = "gcv";
  static void visit(auto& self, auto& visitor) { visitor("degree", self.degree); }
};

/// Throws ArgumentError for another degree.
void check(const GcvSpline& filter);

/// Filters one channel in place.
void smooth(const GcvSpline& filter, double frame_rate, std::span<double> channel);

}  // namespace moclean
