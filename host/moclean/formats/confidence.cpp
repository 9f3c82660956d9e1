#include "moclean/formats/confidence.hpp"

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

}  // namespace moclean
