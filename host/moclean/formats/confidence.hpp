#pragma once

#include "moclean/motion/recording.hpp"

namespace moclean {

/// Gives a recording the confidences that its file states, [frames x columns], NaN where it states
/// none: samples of confidence 0 become missing, the others keep theirs. Where all that the file
/// states is 0 it says nothing: false, and a warning in the recording's notes.
bool take_confidence(Matrix confidence, Recording& recording);

/// The least that a recording has, above 0; 1 if it has none. What is filled is no surer.
double least_confidence(const Recording& recording);

}  // namespace moclean
