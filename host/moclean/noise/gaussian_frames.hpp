#pragma once

#include <string>
#include <string_view>

#include "moclean/core/random.hpp"
#include "moclean/core/specification.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Noise of Peng et al., equation (7): `frames` frames drawn without replacement; in such a frame
/// each entry gets, with probability 1/2, a Gaussian of the given mean and standard deviation.
struct GaussianFrames {
  Index frames = -1;    ///< number of frames touched; -1: use `fraction`
  double fraction = 0;  ///< share of the frames touched, 0..1, rounded to whole frames
  double mean = 1;      ///< in the unit of the clip
  double sd = 1.2;      ///< in the unit of the clip, >= 0

  bool operator==(const GaussianFrames&) const = default;

  static constexpr std::string_view name = "gaussian-frames";
};

/// Reads the keys frames or fraction (one of them is required), mean and sd.
GaussianFrames parse_gaussian_frames(const Specification& specification);

std::string to_string(const GaussianFrames& noise);

/// Adds the noise to the clip's samples and returns the entries it touched; NaN entries stay as
/// they are. Every entry of a chosen frame consumes its draws whatever it holds, so the noise does
/// not depend on the samples. Throws ArgumentError if a parameter is out of range or there are
/// fewer frames than asked for.
Mask add_noise(const GaussianFrames& noise, Random& random, Recording& clip);

}  // namespace moclean
