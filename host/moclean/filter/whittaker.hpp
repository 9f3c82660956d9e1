#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

// Penalised least squares (Whittaker 1923, Eilers 2003). Delta is the difference of the given
// order, sums run over observed samples and over all differences: a gap has no say in the first
// sum, the curve runs through it, joins its sides, and is left out of the result: gaps stay gaps.
// The ends are free (the penalty knows no frames beyond them). A channel with no more samples than
// `difference` is left as it is.

/// minimise  sum (y - z)^2 + lambda sum (Delta z)^2
///
/// A slow sinusoid of f Hz passes with the gain 1 / (1 + lambda (2 sin(pi f / rate))^(2
/// difference)).
struct Whittaker {
  double lambda = 100;   ///< above 0, at most 1e10; beyond 1e8 rounding is felt
  Index difference = 2;  ///< 1, 2 or 3

  bool operator==(const Whittaker&) const = default;

  static constexpr std::string_view name = "whittaker";
  static void visit(auto& self, auto& visitor) {
    visitor("lambda", self.lambda);
    visitor("difference", self.difference);
  }
};

/// minimise  sum |y - z| + lambda sum (Delta z)^2
///
/// which gross errors do not pull: a sample's pull is 1 however far away it is. By reweighted least
/// squares, from the curve of weights lambda/100 on: weights 1 / max(|y - z|, delta), so that
/// errors below `delta` are measured by their square (Huber), until no sample moves by more than
/// delta/1000, or `iterations` times. No weight is below lambda / 1e10, beyond which rounding would
/// have the say: that limits how far away an error can be to pull no more than others.
///
/// Both parameters have a unit. Where they are not given they follow the channel, so that its unit
/// does not matter: lambda is 1000 over the range of 95 % of its samples (or a millionth of that of
/// all, if that is more), delta a thousandth of it.
struct RobustWhittaker {
  std::optional<double> lambda = {};  ///< above 0, at most 1e10, one over the unit of the clip
  Index difference = 2;               ///< 1, 2 or 3
  std::optional<double> delta = {};   ///< above 0, in the unit of the clip
  int iterations = 100;               ///< 1 to 10000

  bool operator==(const RobustWhittaker&) const = default;

  static constexpr std::string_view name = "whittaker-l1";
  static void visit(auto& self, auto& visitor) {
    visitor("lambda", self.lambda);
    visitor("difference", self.difference);
    visitor("delta", self.delta);
    visitor("iterations", self.iterations);
  }
};

/// Throws ArgumentError for parameters out of range.
void check(const Whittaker& filter);
void check(const RobustWhittaker& filter);

/// Filters one channel in place.
void smooth(const Whittaker& filter, double frame_rate, std::span<double> channel);
void smooth(const RobustWhittaker& filter, double frame_rate, std::span<double> channel);

}  // namespace moclean
