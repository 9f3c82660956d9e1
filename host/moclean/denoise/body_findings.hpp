#pragma once

#include <vector>

#include "moclean/body/body_take.hpp"
#include "moclean/body/taken_back.hpp"
#include "moclean/solve/motion_prior.hpp"

namespace moclean {

/// What a take tells of its body before anything is fitted.
struct BodyFindings {
  MotionPrior prior;                 ///< of the whole take; size 0: there is no body
  Mask bad;                          ///< [frames x joints]: distances say it is wrong
  NoisyBones bones;                  ///< empty where a distance is exact
  std::vector<Index> other_motions;  ///< frames in which another motion begins, ascending
  double smallest = 0;               ///< least spread of a distance, unit of the take
};

/// Looks at the distances between the joints of `take`, the body of `samples` [frames x columns].
/// Nothing is filled yet.
BodyFindings look_at(const BodyTake& take, const Matrix& samples);

/// Fills the gaps and what is bad of each of the motions from that motion alone (fill_gaps):
/// `positions` and `variance` of the prior. Confirmed is no more what is bad.
void fill_from_body(const BodyTake& take, BodyFindings& found);

}  // namespace moclean
