#pragma once

#include <cstdint>

#include "moclean/core/random.hpp"
#include "moclean/motion/recording.hpp"
#include "moclean/noise/noise.hpp"

namespace moclean::test {

/// Adds `noise` to `recording` and returns what it touched.
template <class Noise>
Mask spoil(const Noise& noise, Recording& recording, std::uint64_t seed = 1) {
  Random random(seed);
  return add_noise(noise, random, recording);
}

}  // namespace moclean::test
