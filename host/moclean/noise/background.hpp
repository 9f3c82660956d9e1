#pragma once

#include <optional>
#include <string_view>

#include "moclean/core/parameters.hpp"
#include "moclean/core/random.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

// What lies under a whole recording: noise of the system that made it, no gross error.

/// Gaussian noise that is correlated in time, as the poses of depth cameras and video have: white
/// noise through one pass of a Butterworth low-pass of second order (the section of
/// filter/butterworth at order 2), independent for every column, begun in its stationary state, so
/// that the first frame is like any other. Needs the frame rate.
struct Jitter {
  std::optional<double> sd = {};      ///< of every coordinate, in the unit of the clip, >= 0
  std::optional<double> cutoff = {};  ///< Hz, from 1e-4 up to below 1/2 of the frame rate

  bool operator==(const Jitter&) const = default;

  static constexpr std::string_view name = "jitter";
  static void visit(auto& self, auto& visitor) {
    visitor("sd", self.sd);
    visitor("cutoff", self.cutoff);
  }
};

/// Every coordinate becomes the nearest multiple of the step, halves away from zero, as in files
/// that are written with few digits.
struct Round {
  std::optional<double> step = {};  ///< in the unit of the clip, > 0

  bool operator==(const Round&) const = default;

  static constexpr std::string_view name = "round";
  static void visit(auto& self, auto& visitor) { visitor("step", self.step); }
};

/// White Gaussian noise that is given in millimetres, whatever the clip's unit is.
struct White {
  std::optional<double> sd_mm = {};    ///< of every coordinate, >= 0
  std::optional<double> unit_mm = {};  ///< millimetres of the clip's unit, > 0; default: what
                                       ///< millimetres() says of it

  bool operator==(const White&) const = default;

  static constexpr std::string_view name = "white";
  static void visit(auto& self, auto& visitor) {
    visitor("sd-mm", self.sd_mm);
    visitor("unit-mm", self.unit_mm);
  }
};

/// Throws ArgumentError for parameters that are missing or out of range.
void check(const Jitter& noise);
void check(const Round& noise);
void check(const White& noise);

/// Adds the noise to the clip's samples; touched is every observed entry, as for Gaussian. NaN
/// stays NaN and untouched; draws do not depend on the samples. Throws ArgumentError if the frame
/// rate or the unit that the noise needs is unknown, or if the cut-off does not fit the rate.
Mask add_noise(const Jitter& noise, Random& random, Recording& clip);
Mask add_noise(const Round& noise, Random& random, Recording& clip);
Mask add_noise(const White& noise, Random& random, Recording& clip);

}  // namespace moclean
