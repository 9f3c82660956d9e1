#pragma once

#include "moclean/core/matrix.hpp"

namespace moclean {

/// The step to which samples were rounded, in the unit of `data` ([frames x columns], NaN where
/// missing): the second differences over time that are not 0 are multiples of it, but for a
/// minority. Offsets of columns do not matter; a step below 1e-4 of the largest magnitude is found
/// only if it is exact to 1e-10 of that, as in a file of a few digits. 0 if there is none.
double rounding_step(const ConstMatrixRef& data);

/// Standard deviation of what rounding does to a sample: rounding_step / sqrt(12).
double rounding_deviation(const ConstMatrixRef& data);

}  // namespace moclean
