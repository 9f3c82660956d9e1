#pragma once

#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// A take as a body in motion: joints of three columns x, y, z.
struct BodyTake {
  Matrix positions;       ///< [frames x 3 joints], any length unit; 0 where not seen
  Mask seen;              ///< [frames x joints]: all three coordinates were observed
  double frame_rate = 0;  ///< Hz, above 0

  Index frames() const { return positions.rows(); }
  Index joints() const { return seen.cols(); }
  auto position(Index frame, Index joint) const {
    return positions.row(frame).segment<3>(3 * joint);
  }
};

/// The body of `samples` [frames x columns], NaN where missing. Throws ShapeError if the columns
/// are no multiple of three.
BodyTake body_take(const Matrix& samples, double frame_rate);

/// The odd number of frames nearest to a time, but no less than `least`.
Index odd_frames(double seconds, double frame_rate, Index least = 3);

/// Median over frames and joints of the distance of a joint from the frame's median joint (the
/// median x, y and z of all): about 7 ASF units or half a metre of a person. 0 if nothing was seen.
double body_size(const BodyTake& take);

/// Distances of two joints in the frames in which both were seen: all frames of a short take, every
/// so many that 400 to 800 are looked at of a longer one.
std::vector<double> sampled_distances(const BodyTake& take, Index first, Index second);

}  // namespace moclean
