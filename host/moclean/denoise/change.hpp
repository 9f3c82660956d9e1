#pragma once

#include <string>

#include "moclean/denoise/sample_status.hpp"

namespace moclean {

/// How much a take was changed.
struct Change {
  double corrected = 0;  ///< share of all samples that were observed and have another value now
  double filled = 0;     ///< share of all samples that were not observed and have a value now

  /// The joint that was moved farthest in a frame, as far as it was observed; at distance 0 and
  /// without a name if all are where they were. One at 0, 0, 0 that is elsewhere now was lost, not
  /// moved.
  struct Largest {
    double distance = 0;  ///< in the unit of the take
    std::string joint;
    Index frame = 0;
  };
  Largest largest = {};
  double body_size = 0;  ///< of the joints that move, see body_size(); 0 where there are none

  /// The largest distance as a share of the body's size; 0 where there is neither.
  double largest_share() const { return body_size > 0 ? largest.distance / body_size : 0; }
};

/// Compares the motion of a result, of the same shape, with its take, given what count_status()
/// says of the samples.
Change change_of(const Recording& take, const Matrix& motion, const StatusCounts& counts);

}  // namespace moclean
