#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean::opencl {

/// What a segment takes of a device, in bytes.
struct SegmentSize {
  std::uint64_t memory = 0;   ///< of all a batch holds for it
  std::uint64_t stacked = 0;  ///< of its rows in one stacked matrix
};

/// What bounds the batches of a solve.
struct BatchBounds {
  static constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();

  std::uint64_t memory = none;      ///< bytes all batches in flight may take together
  std::uint64_t allocation = none;  ///< bytes of a stacked matrix of one batch
  std::uint64_t cache = none;       ///< bytes of the cache that all batches in flight share
  int queues = 1;                   ///< most batches in flight, at least 1
  Index lanes = 1;                  ///< segments the eigensolver takes in the time of one
  Index segments = 0;               ///< of each batch but the last; 0: what suits the others
};

/// Which segments are solved together: batch i is the segments first[i] up to first[i + 1].
struct BatchPlan {
  std::vector<Index> first = {0};
  int queues = 1;            ///< batches in flight
  int permitted_queues = 1;  ///< as many as the memory has room for

  Index batches() const { return static_cast<Index>(first.size()) - 1; }
};

/// Divides segments, in their order, into batches within the bounds of memory and allocation.
///
/// As far as these permit, batches fill the lanes of the eigensolver, all in flight take at most
/// three quarters of the cache, and the queues get equal shares. Where one set of lanes per queue
/// does not fit the cache, or would leave a queue without work, batches have fewer segments. Fewer
/// queues are used where a queue's share of the memory would not hold the largest segment, or where
/// there are not enough batches.
///
/// Each segment has to be within memory and allocation by itself.
BatchPlan plan_batches(const std::vector<SegmentSize>& sizes, const BatchBounds& bounds);

}  // namespace moclean::opencl
