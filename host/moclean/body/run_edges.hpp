#pragma once

#include "moclean/body/body_take.hpp"

namespace moclean {

/// Whether a run of frames [first, last) in which a joint is flagged begins or ends as errors do,
/// by a jump: the acceleration across one of its ends exceeds three times the median of those
/// between samples without a flag over 0.25 s on either side, or of that of white noise of the
/// deviation `noise` in every coordinate if that is larger. Where there is none to compare with, it
/// does. An end of the take shows nothing; nor does a sample that was not seen. `flags` is [frames
/// x joints].
bool has_edge(const BodyTake& take, const Mask& flags, Index joint, Index first, Index last,
              double noise);

}  // namespace moclean
