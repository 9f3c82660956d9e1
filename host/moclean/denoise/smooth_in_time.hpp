#pragma once

#include "moclean/denoise/moving_part.hpp"

namespace moclean {

/// Whether a frame tells anything of those after it, so that there is a motion to smooth. False
/// only on clear evidence: of at least four columns, each over 1.4826 times its median absolute
/// deviation and without samples beyond three of those, three quarters have an autocorrelation
/// of less than 0.2, in size, at each of the lags 1, 2, 3, 4, 6 and 8, or one below -0.2 at lag 1:
/// they go back and forth with every frame; and the columns' own deviation is no less
/// than that between their medians: noise about a body at rest is small beside the body. Takes of
/// fewer than 20 frames always pass.
///
/// The autocorrelation of white noise is below 1 / sqrt(frames) in two columns of three, so that
/// 60 frames hardly ever suffice for a refusal, 100 do.
bool smooth_in_time(const MovingPart& part);

}  // namespace moclean
