#pragma once

#include <span>
#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

/// Least-squares polynomial of the window around each frame, read off at the frame (Savitzky, Golay
/// 1964).
///
/// Every run of observed samples is filtered by itself, gaps stay gaps. Edges are those of SciPy's
/// mode "interp": the half window at either end is read off the polynomial of the outermost whole
/// window. A run shorter than the window is replaced by one polynomial, of a degree below its
/// length.
struct SavitzkyGolay {
  Index window = 11;  ///< frames, odd, at most 999
  Index order = 3;    ///< degree of the polynomial, below window, at most 12

  bool operator==(const SavitzkyGolay&) const = default;

  static constexpr std::string_view name = "savitzky-golay";
  static void visit(auto& self, auto& visitor) {
    visitor("window", self.window);
    visitor("order", self.order);
  }
};

/// Throws ArgumentError for parameters out of range.
void check(const SavitzkyGolay& filter);

/// Filters one channel in place.
void smooth(const SavitzkyGolay& filter, double frame_rate, std::span<double> channel);

}  // namespace moclean
