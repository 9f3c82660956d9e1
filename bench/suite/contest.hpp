#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "suite/contestant.hpp"
#include "suite/takes.hpp"

namespace moclean::bench {

/// Times all contestants on one workload, in turn: every repetition times each of them once, so
/// that whatever else the machine does falls on all. Before that, each solves it untimed and is
/// compared with the Eigen reference (with the textbook LAPACK peer beyond 64 segments, which the
/// reference would take minutes for).
///
/// Throws Error if a segment of A differs by more than the contestant's `agreement`, or in its
/// number of iterations where the contestant was asked for the usual tolerance.
///
/// The record holds the workload's size and per contestant, in order: name, seconds and frames per
/// second, largest difference of A, and the ratio of its seconds to those of the first contestant
/// in the same repetition.
nlohmann::json contest(const Workload& workload, std::span<const Contestant> contestants,
                       int repetitions);

}  // namespace moclean::bench
