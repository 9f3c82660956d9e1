#pragma once

#include <array>
#include <span>
#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

/// Fills gaps from the observed samples of the channel, which stay as they are:
///   linear  the straight line between the two sides
///   cubic   the natural cubic spline through all observed samples: two continuous derivatives, the
///           second one zero at the first and last observed sample
///   pchip   piecewise cubic, monotone where the samples are (Fritsch, Carlson 1980): it overshoots
///           neither side. Slopes are weighted harmonic means of the two secants (Fritsch, Butland
///           1984), at the first and last observed sample three-point differences, limited
///
/// Before the first observed sample and after the last the nearest one is held. Of two samples
/// cubic and pchip make the straight line, one sample is held throughout; a channel without any
/// stays missing.
struct Interpolate {
  enum class Kind { linear, cubic, pchip };

  Kind kind = Kind::linear;

  bool operator==(const Interpolate&) const = default;

  static constexpr std::string_view name = "interpolate";
  static constexpr bool fills_gaps = true;
  static constexpr std::array<std::string_view, 3> kinds = {"linear", "cubic", "pchip"};
  static void visit(auto& self, auto& visitor) { visitor("kind", self.kind, kinds); }
};

/// Has nothing to refuse.
inline void check(const Interpolate&) {}

/// Fills one channel in place.
void smooth(const Interpolate& filter, double frame_rate, std::span<double> channel);

}  // namespace moclean
