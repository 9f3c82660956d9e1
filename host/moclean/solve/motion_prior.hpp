#pragma once

#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// Two joints, runs of neighbouring columns of one length, whose distance is constant.
struct DistanceLink {
  Index first = 0;
  Index second = 0;
  double length = 0;   ///< unit of the data
  bool hard = false;   ///< constant up to the noise: joints at its ends move together
  bool exact = false;  ///< a length to build on in gaps

  bool operator==(const DistanceLink&) const = default;
};

/// What is known of the motion in one segment beside its samples.
struct MotionPrior {
  double size = 0;      ///< unit of the floors of noise, a body's size; 0: that of the data
  double noise = 0;     ///< least sigma: noise that neighbouring frames share hides from them
  Mask confirmed = {};  ///< [frames x joints]: samples the links say are right; or empty
  std::vector<DistanceLink> links = {};
  Matrix positions = {};   ///< [frames x columns]: where missing samples should be; or empty
  Matrix variance = {};    ///< [frames x joints], of a column of that; infinite: not known
  Matrix confidence = {};  ///< c, [frames x columns], above 0: the noise of a sample has the
                           ///< variance sigma^2 / c; or empty: 1
};

}  // namespace moclean
