#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "moclean/motion/clip.hpp"
#include "moclean/noise/gaussian_frames.hpp"

namespace moclean {

/// Every noise model there is.
using Noise = std::variant<GaussianFrames>;

/// Reads `name:key=value,key=value`, for instance `gaussian-frames:frames=400,mean=1,sd=1.2`.
/// Throws ArgumentError naming the part that is wrong and what would be right.
Noise parse_noise(std::string_view specification);

/// The specification `parse_noise` reads back to the same noise.
std::string to_string(const Noise& noise);

/// A noisy clip and where it differs from the clean one; entries that were NaN count as untouched.
struct Corrupted {
  Clip clip;
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      touched;  ///< [frames x columns]
};

/// Adds noise; the same clip, noise and seed give the same bits on every platform.
/// NaN entries stay NaN. Throws ArgumentError if a parameter is out of range or the noise does not
/// fit the clip (more frames than it has).
Corrupted corrupt(const Clip& clip, const Noise& noise, std::uint64_t seed);

}  // namespace moclean
