#pragma once

#include "moclean/body/body_take.hpp"

namespace moclean {

/// Positions of joints that are not seen, as the body says.
struct Fills {
  Matrix positions;  ///< [frames x 3 joints]; 0 where seen, or where nothing is known
  Matrix variance;   ///< [frames x joints], of a coordinate; infinite where there is no position

  bool empty() const { return positions.size() == 0; }
};

/// Fills the gaps of `least` frames and more from the joints that are seen throughout a gap:
/// carried by the steadiest as by a rigid body, and by regression on the posture
/// (PostureRegression), weighed by trials (learn_fill_rule). Without neighbours or trials a joint
/// is held between the edges of its gap. Shorter gaps are not filled, but bridged by straight lines
/// for what they tell of others. `floor` is the deviation of a distance below which it is
/// as steady as any. Of very many gaps only the longest, one per ten frames, are regressed. Without
/// any gap the result is empty.
Fills fill_gaps(BodyTake take, double floor, Index least);

}  // namespace moclean
