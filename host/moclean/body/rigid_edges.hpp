#pragma once

#include <vector>

#include "moclean/body/body_take.hpp"

namespace moclean {

/// Deviation of a distance over that of the coordinates at its ends: about sqrt 2.
inline constexpr double noise_of_distance = 1.4;

/// A distance that is farther from its length than so many deviations is off.
inline constexpr double off_deviations = 5;

/// Two joints whose distance hardly changes in a take.
struct RigidEdge {
  Index first = 0;
  Index second = 0;
  double length = 0;   ///< centre of the distances
  double spread = 0;   ///< their deviation, of the steadiest third
  double share = 1;    ///< one over the edges that say the same, of joints at the same places
  bool hard = false;   ///< rigid: the spread is that of the measurement
  bool exact = false;  ///< a length to build on: the spread is far below that
};

/// The skeleton that a take shows by itself: distances that stay, learned from the shortest
/// interval that holds a third of each pair's distances: two neighbours that drift may be wrong for
/// more than half of the take together. Ends of a limb that is straight for that long look rigid,
/// too, but their distances fall short of it gradually and never exceed it: such a pair does not
/// count where both joints have two other rigid ones.
struct RigidBody {
  std::vector<RigidEdge> edges;  ///< among the six steadiest of either joint
  std::vector<bool> testable;    ///< [joints]: has a hard edge, so its errors show as wrong lengths

  bool empty() const { return edges.empty(); }
  bool is_rigid() const;  ///< has a hard edge, so that the votes of joints tell
};

/// A distance of two joints, and how much its frame counts.
struct WeighedDistance {
  double value = 0;
  double weight = 1;
};

/// Centre and spread of distances, from the shortest interval that holds more than a third of the
/// weight; an infinite spread for 20 of them or fewer. Sorts them.
struct Core {
  double centre = 0;
  double spread = 0;
};
Core steady_core(std::vector<WeighedDistance>& distances);
Core steady_core(const std::vector<double>& distances);  ///< all of the same weight

/// Learns the body. `smallest` is the spread that measurement noise gives a constant distance, in
/// the unit of the take. `rounding` is the deviation that rounding gives a coordinate: where that
/// is not far below, a distance that stays for long only shows that both joints stood still, and
/// none is exact. Every frame of a short take is looked at, 400 to 800 of a longer one.
RigidBody learn_rigid_body(const BodyTake& take, double smallest, double rounding = 0);

}  // namespace moclean
