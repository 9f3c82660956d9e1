#pragma once

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "moclean/core/matrix.hpp"

#include "support/tolerance.hpp"

namespace moclean::test {

/// A slow wave with a deterministic roughness and one gross error: what the figures of SciPy 1.10.1
/// in these tests were computed from (t = numpy.arange(40)):
///   y = 10 sin(0.3 t) + 0.4 ((37 t) % 11 - 5) + (25 where t == 17)
inline std::vector<double> rough_wave() {
  std::vector<double> y;
  for (int t = 0; t < 40; ++t)
    y.push_back(10 * std::sin(0.3 * t) + 0.4 * (37 * t % 11 - 5) + (t == 17 ? 25 : 0));
  return y;
}

/// The filtered channel.
template <class Filter>
std::vector<double> smoothed(const Filter& filter, std::vector<double> channel, double rate = 0) {
  check(filter);
  smooth(filter, rate, channel);
  return channel;
}

/// A frame and what it becomes.
struct Sample {
  std::size_t frame;
  double value;
};

inline void expect_samples(const std::vector<double>& found, const std::vector<Sample>& expected) {
  for (const Sample& sample : expected)
    EXPECT_NEAR(found[sample.frame], sample.value, tolerance::scipy()) << "frame " << sample.frame;
}

}  // namespace moclean::test
