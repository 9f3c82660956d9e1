#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "moclean/core/matrix.hpp"
#include "moclean/core/random.hpp"

namespace moclean::test {

/// A made-up body of rigid bones, [frames x 3 joints]: joint 0 walks about, each other joint hangs
/// on joint (j - 1) / 2 by a bone of constant length 1 + j / 10 whose direction swings smoothly.
inline Matrix swinging_limbs(Index frames, Index joint_count, std::uint64_t seed = 1) {
  constexpr double turn = 2 * std::numbers::pi;
  Random random(seed);
  Matrix p = Matrix::Zero(frames, 3 * joint_count);
  for (Index f = 0; f < frames; ++f) {
    const double t = static_cast<double>(f) / 120;
    p.row(f).head(3) << 10 + std::sin(turn * 0.3 * t), 12 + 0.1 * std::cos(turn * 0.9 * t), 8 + t;
  }
  for (Index j = 1; j < joint_count; ++j) {
    const std::array<double, 4> phase = {turn * random.uniform(), turn * random.uniform(),
                                         turn * random.uniform(), turn * random.uniform()};
    const double speed = 0.4 + 0.5 * random.uniform();
    for (Index f = 0; f < frames; ++f) {
      const double t = static_cast<double>(f) / 120;
      const double a = phase[0] + 0.8 * std::sin(turn * speed * t + phase[1]);
      const double b = phase[2] + 0.6 * std::cos(turn * speed * t + phase[3]);
      const Eigen::RowVector3d bone(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b),
                                    std::sin(b));
      p.row(f).segment<3>(3 * j) =
          p.row(f).segment<3>(3 * ((j - 1) / 2)) + (1 + 0.1 * static_cast<double>(j)) * bone;
    }
  }
  return p;
}

}  // namespace moclean::test
