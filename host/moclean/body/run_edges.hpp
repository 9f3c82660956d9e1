#pragma once

#include "moclean/body/body_take.hpp"

namespace moclean {

/// Whether frames [first, last) of a joint begin or end as errors do, by a jump: the acceleration
/// across one of the two ends exceeds five times its median over 0.25 s on either side of the run
/// plus eight times `noise`, the deviation of a coordinate. An end of the take shows nothing; nor
/// does a sample that was not seen.
bool has_edge(const BodyTake& take, Index joint, Index first, Index last, double noise);

}  // namespace moclean
