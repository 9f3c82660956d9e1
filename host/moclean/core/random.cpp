#include "moclean/core/random.hpp"

#include <cmath>
#include <string>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

// Natural logarithm for x in (0, 1] from exactly rounded operations only, error below 4e-16 (1 +
// |ln x|): x = m 2^e with m in [sqrt(1/2), sqrt(2)), ln m = 2 atanh(z), z = (m - 1)/(m + 1), |z| <
// 0.1716.
double portable_log(double x) {
  constexpr double sqrt_half = 0.70710678118654752440;
  constexpr double ln2 = 0.69314718055994530942;
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < sqrt_half) {
    m *= 2;
    --exponent;
  }
  const double z = (m - 1) / (m + 1);
  const double z2 = z * z;
  double series = 0;
  for (int k = 23; k >= 1; k -= 2) series = series * z2 + 1.0 / k;
  return exponent * ln2 + 2 * z * series;
}

}  // namespace

double Random::uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }

std::uint64_t Random::below(std::uint64_t bound) {
  const std::uint64_t remainder = (UINT64_MAX % bound + 1) % bound;  // 2^64 mod bound
  std::uint64_t draw = generator_();
  while (draw > UINT64_MAX - remainder) draw = generator_();
  return draw % bound;
}

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double u = 0, v = 0, s = 0;
  do {
    u = 2 * uniform() - 1;
    v = 2 * uniform() - 1;
    s = u * u + v * v;
  } while (s >= 1 || s == 0);
  const double scale = std::sqrt(-2 * portable_log(s) / s);
  spare_ = v * scale;
  has_spare_ = true;
  return u * scale;
}

std::vector<Index> Random::choose(Index count, Index size) {
  if (count < 0 || count > size)
    throw ArgumentError("cannot choose " + std::to_string(count) + " of " + std::to_string(size));
  std::vector<Index> chosen;
  chosen.reserve(static_cast<std::size_t>(count));
  for (Index i = 0; i < size && count > 0; ++i)
    if (below(static_cast<std::uint64_t>(size - i)) < static_cast<std::uint64_t>(count)) {
      chosen.push_back(i);
      --count;
    }
  return chosen;
}

}  // namespace moclean
