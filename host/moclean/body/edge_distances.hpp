#pragma once

#include <cstddef>
#include <span>

#include "moclean/body/rigid_edges.hpp"

namespace moclean {

/// The distances of edges in every frame.
struct EdgeDistances {
  Matrix values;  ///< [frames x edges]
  Mask both;      ///< [frames x edges]: both ends were seen
};

EdgeDistances edge_distances(const BodyTake& take, std::span<const RigidEdge> edges);

/// Centres and limits to compare distances with, one per edge.
struct EdgeLimits {
  explicit EdgeLimits(std::size_t edges)
      : centre(static_cast<Index>(edges)), limit(static_cast<Index>(edges)) {}

  Eigen::Array<double, 1, Eigen::Dynamic> centre, limit;
};

}  // namespace moclean
