#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "moclean/core/random.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean::test {

/// A made-up walk: 31 joints, 93 columns, 120 Hz, positions within about +-20 units as in ASF
/// files.
///
/// Joint columns swing about a rest position with the first three harmonics of the step, amplitudes
/// and phases drawn per column. Step rate, forward speed and the share of each harmonic drift over
/// the take, so that a short stretch has a lower rank than the whole, as in real motion.
inline Recording synthetic_walk(Index frames, std::uint64_t seed = 1) {
  constexpr Index joint_count = 31;
  constexpr double rate = 120;
  constexpr double turn = 2 * std::numbers::pi;
  constexpr std::array axis_names = {"x", "y", "z"};
  Random random(seed);

  Recording walk{
      .samples = Matrix(frames, 3 * joint_count), .columns = {}, .frame_rate = rate, .unit = ""};
  for (Index c = 0; c < 3 * joint_count; ++c) {
    walk.columns.push_back("joint" + std::to_string(c / 3) + "." +
                           axis_names[static_cast<std::size_t>(c % 3)]);
    const double rest = 20 * (2 * random.uniform() - 1);
    std::array<double, 3> amplitude{}, phase{}, drift{};
    for (std::size_t h = 0; h < 3; ++h) {
      amplitude[h] = 3 * random.uniform() / static_cast<double>(h + 1);
      phase[h] = turn * random.uniform();
      drift[h] = turn * random.uniform();
    }
    for (Index f = 0; f < frames; ++f) {
      const double t = static_cast<double>(f) / rate;
      const double steps = 0.9 * t + 0.4 * std::sin(0.5 * t);
      double x = rest + (c % 3 == 2 ? 2 * t + std::sin(0.3 * t) : 0);
      for (std::size_t h = 0; h < 3; ++h)
        x += amplitude[h] * (1 + 0.5 * std::sin(0.4 * t + drift[h])) *
             std::sin(turn * static_cast<double>(h + 1) * steps + phase[h]);
      walk.samples(f, c) = x;
    }
  }
  return walk;
}

}  // namespace moclean::test
