#pragma once

#include <string>
#include <vector>

#include "moclean/motion/recording.hpp"

namespace moclean {

/// How far an estimate is from the truth. Every figure is in the clips' unit.
struct Comparison {
  struct JointError {
    std::string name;
    double rmse = 0;     ///< root of the mean squared entry difference over the joint's columns
    double largest = 0;  ///< largest absolute entry difference
    Index largest_frame = 0;
  };

  double fd = 0;      ///< |truth - estimate|_F / sqrt(frames x columns); Peng et al., equation (8)
  Index changed = 0;  ///< entries in which the two differ at all
  double rmse_changed = 0;  ///< root mean square of the difference over those entries; 0 if none
  double largest = 0;       ///< largest absolute entry difference
  std::string worst_joint;  ///< joint with the largest rmse; empty if the clips do not differ
  std::vector<JointError> joints;
  Index not_compared = 0;  ///< entries that are NaN in either; they take part in no figure
};

/// Compares two clips of equal shape. Throws ShapeError if the shapes differ or if there is no
/// entry that both have observed.
Comparison compare(const Recording& truth, const Recording& estimate);

/// FD of equation (8) alone, [frames x columns] each. NaN entries count in neither sum nor size.
/// Throws as compare().
double frobenius_distance(const ConstMatrixRef& truth, const ConstMatrixRef& estimate);

}  // namespace moclean
