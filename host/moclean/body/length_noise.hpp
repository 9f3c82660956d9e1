#pragma once

#include "moclean/body/body_take.hpp"

namespace moclean {

/// Measurement noise as lengths that ought to be constant show it, per coordinate.
struct LengthNoise {
  double deviation = 0;  ///< of a sample
  double slow = 0;       ///< of white noise that is as strong at low frequencies
  bool steady = false;   ///< there all the time, whether the body moves or not
  double lasting = 1;    ///< largest correlation of a length with itself 0.25 to 1 s later

  /// Neighbouring frames err alike, so that differences in time hide the noise: they show `dense`,
  /// less than half of it. And it is no play of skin and joints, which rest while the body does,
  /// and are less than 0.8 % of its `size`: 3 mm of a person. Nor is it motion between joints
  /// without a bone, which is more than 10 % of the size, or lasts, or comes back with the
  /// next step: docs/decisions/correlated-noise.md.
  bool correlated(double size, double dense) const;
};

/// The noise of a take from the distance of every joint to its steadiest neighbour: a bone's length
/// is constant, so that what is left of it is the noise of its two ends, whatever the motion. The
/// median over the pairs, eight at least, else 0; frames in which a length is far off are left out.
///
/// The slow part is the sum of the autocovariances over lags up to 0.25 s, as long as they are
/// above 0: the spectral density at frequency 0. The noise is steady if the changes of all lengths
/// from frame to frame have 0.6 of their mean power at least in nine of ten stretches of 0.25 s, of
/// four at least. Rounded data is not: there lengths often stay the same.
LengthNoise length_noise(const BodyTake& take);

/// Share in [0, 1] of the way from the positions of `take` to `motion` [frames x 3 joints] that is
/// expected to be nearest to the truth: the noise that motion has taken away, n'(n - n'), over the
/// squared way, as in Stein's unbiased estimate of the risk. The lengths of length_noise() tell the
/// noise that was taken away. Less than 1 where motion was taken away with it. 1 without lengths.
double worthwhile_share(const BodyTake& take, const Matrix& motion);

}  // namespace moclean
