#include "moclean/formats/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace moclean {

bool take_confidence(Matrix confidence, Recording& recording) {
  const auto stated = !confidence.array().isNaN();
  if (!stated.any()) return false;
  const Mask unseen = confidence.array() == 0;
  if ((unseen == stated).all()) {
    recording.notes.warnings.push_back("every confidence is 0: they are not used");
    return false;
  }
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  recording.samples = unseen.select(missing, recording.samples);
  recording.confidence = unseen.select(missing, confidence);
  return true;
}

double least_confidence(const Recording& recording) {
  double least = std::numeric_limits<double>::infinity();
  for (const double c : recording.confidence.reshaped())
    if (c > 0) least = std::min(least, c);
  return std::isfinite(least) ? least : 1;
}

}  // namespace moclean
