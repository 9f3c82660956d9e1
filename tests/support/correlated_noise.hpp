#pragma once

#include <cmath>

#include "moclean/core/matrix.hpp"
#include "moclean/core/random.hpp"

namespace moclean::test {

/// First-order noise of standard deviation 1, [frames x columns]: neighbouring frames correlate by
/// `correlation`. White noise of the deviation sqrt((1 + correlation) / (1 - correlation)) is as
/// strong at low frequencies.
inline Matrix correlated_noise(Index frames, Index columns, double correlation,
                               std::uint64_t seed = 1) {
  Random random(seed);
  Matrix noise(frames, columns);
  const double rest = std::sqrt(1 - correlation * correlation);
  for (Index i = 0; i < frames; ++i)
    for (Index j = 0; j < columns; ++j)
      noise(i, j) =
          i == 0 ? random.normal() : correlation * noise(i - 1, j) + rest * random.normal();
  return noise;
}

}  // namespace moclean::test
