#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "moclean/motion/recording.hpp"
#include "moclean/noise/background.hpp"
#include "moclean/noise/gaussian.hpp"
#include "moclean/noise/gaussian_frames.hpp"
#include "moclean/noise/limbs.hpp"
#include "moclean/noise/runs.hpp"

namespace moclean {

/// Every noise model there is.
using Noise = std::variant<GaussianFrames, Gaussian, Dropout, Burst, Gap, Swap, Drift, Ramp, Jitter,
                           Round, White, LimbSwap, InertialDrift>;

/// What their specifications begin with.
std::vector<std::string_view> noise_names();

/// Reads `name:key=value,key=value`, for instance `gaussian-frames:frames=400,mean=1,sd=1.2`.
/// Throws ArgumentError naming the part that is wrong and what would be right.
Noise parse_noise(std::string_view specification);

/// The specification `parse_noise` reads back to the same noise.
std::string to_string(const Noise& noise);

/// Noises one after the other, each on what the one before left. There is at least one.
using NoiseChain = std::vector<Noise>;

/// Reads `gap:fraction=0.1+gaussian-frames:fraction=0.3`. Throws as parse_noise().
NoiseChain parse_noise_chain(std::string_view specification);

/// The specification `parse_noise_chain` reads back to the same noises.
std::string to_string(const NoiseChain& chain);

/// A noisy clip and what the noise touched: its gross errors, which a method ought to find. Entries
/// that were NaN count as untouched, and so does what the model calls background (see each).
struct Corrupted {
  Recording clip;
  Mask touched;  ///< [frames x columns]
};

/// Adds noise; the same clip, noise and seed give the same bits on every platform.
/// NaN entries stay NaN. Throws ArgumentError if a parameter is out of range or the noise does not
/// fit the clip (more frames than it has).
Corrupted corrupt(const Recording& clip, const Noise& noise, std::uint64_t seed);

/// The same for a chain, whose noises share one sequence of random numbers. Touched is what any of
/// them touched. Throws ArgumentError for an empty chain, too.
Corrupted corrupt(const Recording& clip, const NoiseChain& chain, std::uint64_t seed);

}  // namespace moclean
