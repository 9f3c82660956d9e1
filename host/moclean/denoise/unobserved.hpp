#pragma once

#include "moclean/denoise/denoiser.hpp"

namespace moclean {

/// Names of the columns of a take that have no sample at all, each NaN throughout.
std::vector<std::string> unobserved_columns(const Recording& take);

/// Takes back what a method made of columns that were never observed: nothing is known of them, so
/// that they stay NaN in the motion, are no outliers, and are named in `unobserved`.
void leave_unobserved(const Recording& take, Denoised& result);

}  // namespace moclean
