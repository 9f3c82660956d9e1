#pragma once

#include <vector>

#include "moclean/core/matrix.hpp"
#include "moclean/solve/motion_prior.hpp"

namespace moclean {

/// Moves the joints that are free (`free` is [frames x joints]) along their exact links until the
/// lengths fit, a few Gauss-Seidel sweeps; returns which have such a link, [frames x joints].
/// `positions` is [frames x 3 joints].
Mask put_on_lengths(const std::vector<DistanceLink>& links, const Mask& free, Matrix& positions);

}  // namespace moclean
