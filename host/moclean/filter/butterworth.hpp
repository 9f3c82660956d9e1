#pragma once

#include <span>
#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

/// Butterworth low-pass run forwards and backwards, so that nothing is delayed: the gain is that of
/// one pass squared, 1/2 at the cut-off. Second-order sections by the bilinear transform.
///
/// Every run of observed samples is filtered by itself, gaps stay gaps. Edges are those of SciPy's
/// sosfiltfilt: the run is continued by 3 (order + 1) samples (or as many as it has) reflected in
/// its end point, and the filter starts in the steady state of the first of them.
struct Butterworth {
  double cutoff = 6;  ///< Hz, above 0 and below half the frame rate
  Index order = 4;    ///< of one pass, 1 to 12

  bool operator==(const Butterworth&) const = default;

  static constexpr std::string_view name = "butterworth";
  static constexpr bool needs_frame_rate = true;
  static void visit(auto& self, auto& visitor) {
    visitor("cutoff", self.cutoff);
    visitor("order", self.order);
  }
};

/// Throws ArgumentError for parameters out of range.
void check(const Butterworth& filter);

/// Filters one channel in place. Throws ArgumentError if the cut-off is not below half of
/// `frame_rate` (Hz).
void smooth(const Butterworth& filter, double frame_rate, std::span<double> channel);

}  // namespace moclean
