#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "moclean/noise/runs.hpp"

namespace moclean {

/// A limb of the left side and its like on the right: joints in the clip's order, pair by pair.
using LimbPair = std::vector<std::pair<Joint, Joint>>;

/// The limbs that come in pairs, found by names alone. Two joints are a pair if their names are the
/// same but for left and right, Left and Right, LEFT and RIGHT, l and r, or L and R in one place. A
/// limb is made of pairs whose left joints follow one another in the clip, directly or with only
/// the right one between them (`lhip lknee rhip rknee` and `lhip rhip lknee rknee` are one limb
/// each).
std::vector<LimbPair> limb_pairs(const Recording& clip);

/// The left and the right limb change places throughout a run, the whole chain, as when an
/// estimator of poses takes one for the other. Limbs that come in pairs are equally likely;
/// `fraction` is a share of all such pairs' frames. An entry missing on either side stays as it is.
struct LimbSwap {
  Runs runs = {};

  bool operator==(const LimbSwap&) const = default;

  static constexpr std::string_view name = "limb-swap";
  static void visit(auto& self, auto& visitor) { Runs::visit(self.runs, visitor); }
};

/// Where a recording of an inertial suit goes: the whole body, or one limb of it, gets the same
/// offset at all its joints, which grows slowly and stays. The offset is the integral of a velocity
/// that is a stationary first-order Gauss-Markov process with a correlation time of one second (a
/// residual of double integration between two steps), so it is 0 in the first frame and has, in
/// every coordinate, the standard deviation sd in the last; about sd sqrt(t / duration) before.
/// Only joints of three columns drift. Needs the frame rate.
struct InertialDrift {
  enum class Of { body, limb };

  std::optional<double> sd = {};  ///< of each coordinate at the end, in the unit of the clip, >= 0
  Of of = Of::body;               ///< limb: a left or right limb of limb_pairs(), drawn

  bool operator==(const InertialDrift&) const = default;

  static constexpr std::string_view name = "inertial-drift";
  static constexpr std::array<std::string_view, 2> parts = {"body", "limb"};
  static void visit(auto& self, auto& visitor) {
    visitor("sd", self.sd);
    visitor("of", self.of, parts);
  }
};

/// Throws ArgumentError for parameters that are missing or out of range.
void check(const LimbSwap& noise);
void check(const InertialDrift& noise);

/// Spoils the clip's samples and returns the entries that were changed. NaN stays NaN and
/// untouched; draws do not depend on the samples. Throws ArgumentError if there are no limbs in
/// pairs, a run is longer than the clip, or the frame rate that the drift needs is unknown.
Mask add_noise(const LimbSwap& noise, Random& random, Recording& clip);
Mask add_noise(const InertialDrift& noise, Random& random, Recording& clip);

}  // namespace moclean
