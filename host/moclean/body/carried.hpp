#pragma once

#include "moclean/body/body_take.hpp"

namespace moclean {

/// Positions of joints that are not seen, as their neighbours carry them.
struct Carried {
  Matrix positions;  ///< [frames x 3 joints]; 0 where seen, or where nothing carries the joint
  Matrix variance;   ///< [frames x joints], of a coordinate; infinite where there is no position

  bool empty() const { return positions.size() == 0; }
};

/// Carries joints through their gaps. A gap's neighbours, those of the steadiest distances that are
/// seen throughout, move from the last frame before it to each of its frames as a rigid body does,
/// nearly: the rotation and translation of least weighted squares (Horn 1987) take the joint along;
/// likewise backward from the first frame after it; the two are blended linearly. The same is done
/// to gaps of the same length where the joint was seen: how far off that is gives the variance, and
/// chooses among 3, 5 and 8 neighbours. A gap whose far edges are missed by more than is usual has
/// that much more. Gaps at the ends of a take have one side only. Short gaps,
/// below `least` frames, and those without three such neighbours or trials are left alone.
///
/// `floor` is the deviation of a distance below which it is as steady as any. Without any such gap
/// the result is empty.
Carried carry(const BodyTake& take, double floor, Index least);

}  // namespace moclean
