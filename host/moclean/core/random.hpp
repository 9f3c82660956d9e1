#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// Seeded random numbers that are the same bits on every platform and compiler.
///
/// Generator: std::mt19937_64, whose sequence the C++ standard fixes. The distributions are our
/// own, because those of the standard library differ between implementations, and use only
/// operations IEEE 754 rounds exactly (+ - * / sqrt); even the logarithm is our own.
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  /// Uniform on [0, 1): the upper 53 bits of one draw.
  double uniform();

  /// Uniform integer on [0, bound), bound >= 1, without modulo bias (rejection).
  std::uint64_t below(std::uint64_t bound);

  /// Standard normal by the polar method (Marsaglia and Bray 1964); two per accepted pair.
  double normal();

  /// `count` distinct indices of 0 .. size - 1 in increasing order, every subset equally likely
  /// (selection sampling, Knuth TAOCP 2, algorithm S). Throws ArgumentError if count > size.
  std::vector<Index> choose(Index count, Index size);

 private:
  std::mt19937_64 generator_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace moclean
