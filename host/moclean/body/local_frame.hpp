#pragma once

#include <vector>

#include <Eigen/Core>

#include "moclean/body/body_take.hpp"

namespace moclean {

/// A joint that goes along with another, and how much it counts.
struct Neighbour {
  Index joint;
  double weight;
};
using Neighbours = std::vector<Neighbour>;

/// Where neighbours are in a frame, as a rigid body that has moved from another frame.
struct RigidMotion {
  Eigen::Matrix3d rotation;
  Eigen::RowVector3d from, to;  ///< weighted centres

  Eigen::RowVector3d moved(const Eigen::RowVector3d& position) const {
    return to + (position - from) * rotation.transpose();
  }
  Eigen::RowVector3d moved_back(const Eigen::RowVector3d& position) const {
    return from + (position - to) * rotation;
  }
};

/// The rotation and translation that take the neighbours from one frame to another with least
/// weighted squares (Horn 1987). All must be seen in both.
RigidMotion rigid_motion(const BodyTake& take, const Neighbours& neighbours, Index from, Index to);

}  // namespace moclean
