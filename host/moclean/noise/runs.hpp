#pragma once

#include <optional>
#include <string_view>

#include "moclean/core/parameters.hpp"
#include "moclean/core/random.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Where errors of whole joints over runs of frames fall. Each run takes a joint (for Swap a pair)
/// and `length` consecutive frames, all equally likely; runs may overlap. Exactly one of count and
/// fraction is given.
struct Runs {
  std::optional<Index> count = {};      ///< number of runs
  std::optional<double> fraction = {};  ///< 0..1: so many that their lengths sum to this share of
                                        ///< all joints' frames, rounded to whole runs
  Index length = 60;                    ///< frames of a run, 1 up to the frames of the clip

  bool operator==(const Runs&) const = default;

  static void visit(auto& self, auto& visitor) {
    visitor("count", self.count);
    visitor("fraction", self.fraction);
    visitor("length", self.length);
  }
};

/// Throws ArgumentError, naming the noise, for parameters out of range.
void check_runs(std::string_view noise, const Runs& runs);

/// How many runs there are in a clip with that many places (joints, pairs of limbs) for them.
/// Throws ArgumentError, naming the noise, if a run is longer than the clip.
Index number_of_runs(std::string_view noise, const Runs& runs, Index frames, Index places);

/// An index below `bound`, all equally likely.
Index draw_index(Random& random, Index bound);

/// A joint is displaced by the same vector throughout a run, as by a marker taken for another
/// thing: each coordinate Gaussian(0, sd), drawn per run. Overlapping displacements add up.
struct Burst {
  Runs runs = {};
  double sd = 5;  ///< in the unit of the clip, >= 0

  bool operator==(const Burst&) const = default;

  static constexpr std::string_view name = "burst";
  static void visit(auto& self, auto& visitor) {
    Runs::visit(self.runs, visitor);
    visitor("sd", self.sd);
  }
};

/// A joint is missing (NaN) throughout a run, as behind an occlusion.
struct Gap {
  Runs runs = {};

  bool operator==(const Gap&) const = default;

  static constexpr std::string_view name = "gap";
  static void visit(auto& self, auto& visitor) { Runs::visit(self.runs, visitor); }
};

/// Two joints change places throughout a run, as when a labelling goes wrong. Pairs are drawn among
/// the joints of three columns; among all columns where there are not two such joints. An entry
/// missing in either stays as it is.
struct Swap {
  Runs runs = {};

  bool operator==(const Swap&) const = default;

  static constexpr std::string_view name = "swap";
  static void visit(auto& self, auto& visitor) { Runs::visit(self.runs, visitor); }
};

/// A joint leaves its place evenly during a run, as an inertial sensor drifts, and is back after
/// it: in frame t = 1 .. length of the run it is displaced by t/length of a vector drawn as for
/// Burst.
struct Drift {
  Runs runs = {};
  double sd = 5;  ///< of each coordinate at the end of a run, in the unit of the clip, >= 0

  bool operator==(const Drift&) const = default;

  static constexpr std::string_view name = "drift";
  static void visit(auto& self, auto& visitor) {
    Runs::visit(self.runs, visitor);
    visitor("sd", self.sd);
  }
};

/// A joint is displaced gradually, stays there, and comes back, so that no single frame gives it
/// away. The run has a vector drawn as for Burst; with w = length / 3 rounded down, the joint is
/// displaced by 1/(w + 1), 2/(w + 1) .. w/(w + 1) of it in the first w frames, by all of it in the
/// next length - 2 w, and by the same shares in reverse in the last w.
struct Ramp {
  Runs runs = {};
  double sd = 5;  ///< of each coordinate in the middle of a run, in the unit of the clip, >= 0

  bool operator==(const Ramp&) const = default;

  static constexpr std::string_view name = "ramp";
  static void visit(auto& self, auto& visitor) {
    Runs::visit(self.runs, visitor);
    visitor("sd", self.sd);
  }
};

/// Throws ArgumentError for parameters out of range.
void check(const Burst& noise);
void check(const Gap& noise);
void check(const Swap& noise);
void check(const Drift& noise);
void check(const Ramp& noise);

/// Spoils the clip's samples and returns the entries that were touched. NaN stays NaN and
/// untouched; draws do not depend on the samples. Throws ArgumentError if a run is longer than the
/// clip, or if there are no two joints to swap.
Mask add_noise(const Burst& noise, Random& random, Recording& clip);
Mask add_noise(const Gap& noise, Random& random, Recording& clip);
Mask add_noise(const Swap& noise, Random& random, Recording& clip);
Mask add_noise(const Drift& noise, Random& random, Recording& clip);
Mask add_noise(const Ramp& noise, Random& random, Recording& clip);

}  // namespace moclean
