#pragma once

#include "moclean/motion/recording.hpp"

namespace moclean {

/// What the confidence of a take's samples is to a smoother, [frames x columns]: 1 for those that
/// are as sure as the surest twentieth of the observed ones, less for others, to the power of
/// confidence_exponent(), but at least 0.05. 1 where the file does not say. 0 x 0 where all would
/// be 1.
Matrix confidence_weights(const Recording& take);

/// The power p, 0 to 1, of the confidences c for which noise of the variance 1 / c^p is what the
/// samples show. Fourth differences along time, squared and over the variance that p expects of
/// them, are to have the same median in every class of confidence, each column in its own unit;
/// least squares of the logarithms, with a priori 1 +- 1/2, which is what is left where little can
/// be seen: 1. Confidences that are unrelated to the noise, or that motion hides, end at 0.
double confidence_exponent(const Recording& take);

}  // namespace moclean
