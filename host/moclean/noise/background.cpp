#include "moclean/noise/background.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/motion/unit.hpp"
#include "moclean/noise/gaussian.hpp"

namespace moclean {
namespace {

constexpr double lowest_cutoff = 1e-4;  // of the frame rate: below, the state's variance cancels

double require(std::string_view noise, std::string_view key, const std::optional<double>& value) {
  if (!value) throw ArgumentError(fmt::format("{} needs {}=NUMBER", noise, key));
  if (!(*value >= 0 && std::isfinite(*value)))
    throw ArgumentError(fmt::format("{}: {} is {}, expected at least 0", noise, key, *value));
  return *value;
}

void require_positive(std::string_view noise, std::string_view key,
                      const std::optional<double>& value) {
  if (!(require(noise, key, value) > 0))
    throw ArgumentError(fmt::format("{}: {} is 0, expected a positive number", noise, key));
}

// The low-pass in transposed direct form II,
//   y = b0 x + z1,   z1 <- c1 x - a1 z1 + z2,   z2 <- c2 x - a2 z1,
// and the covariance P of (z1, z2) under white noise of variance 1: P = A P A' + c c'.
struct LowPass {
  double b0, a1, a2, c1, c2;
  double p11, p12, p22;
  double gain;  // makes the variance of y 1

  LowPass(double cutoff, double frame_rate) {
    // The last bits of tan differ between platforms; those of single precision do not.
    const double w =
        static_cast<double>(static_cast<float>(std::tan(std::numbers::pi * cutoff / frame_rate)));
    const double norm = 1 / (1 + std::sqrt(2.0) * w + w * w);
    b0 = w * w * norm;
    a1 = 2 * (w * w - 1) * norm;
    a2 = (1 - std::sqrt(2.0) * w + w * w) * norm;
    c1 = 2 * b0 - a1 * b0;
    c2 = b0 - a2 * b0;
    p11 = (c1 * c1 + c2 * c2 - 2 * a1 * c1 * c2 / (1 + a2)) /
          (1 - a1 * a1 - a2 * a2 + 2 * a1 * a1 * a2 / (1 + a2));
    p12 = (a1 * a2 * p11 + c1 * c2) / (1 + a2);
    p22 = a2 * a2 * p11 + c2 * c2;
    gain = 1 / std::sqrt(b0 * b0 + p11);
  }

  // Adds sd times the noise of variance 1 to a column.
  void add(double sd, Random& random, Index column, Matrix& samples) const {
    const double first = random.normal(), second = random.normal();
    const double l11 = std::sqrt(p11), l21 = p12 / l11;
    double z1 = l11 * first;
    double z2 = l21 * first + std::sqrt(std::max(0.0, p22 - l21 * l21)) * second;
    for (Index f = 0; f < samples.rows(); ++f) {
      const double x = random.normal();
      samples(f, column) += sd * gain * (b0 * x + z1);  // NaN stays NaN
      const double before = z1;
      z1 = c1 * x - a1 * before + z2;
      z2 = c2 * x - a2 * before;
    }
  }
};

Mask observed(const Recording& clip) { return !clip.samples.array().isNaN(); }

}  // namespace

void check(const Jitter& noise) {
  require(Jitter::name, "sd", noise.sd);
  require_positive(Jitter::name, "cutoff", noise.cutoff);
}

void check(const Round& noise) { require_positive(Round::name, "step", noise.step); }

void check(const White& noise) {
  require(White::name, "sd-mm", noise.sd_mm);
  if (noise.unit_mm) require_positive(White::name, "unit-mm", noise.unit_mm);
}

Mask add_noise(const Jitter& noise, Random& random, Recording& clip) {
  check(noise);
  const double rate = clip.frame_rate, cutoff = *noise.cutoff;
  if (!(rate > 0))
    throw ArgumentError(fmt::format(
        "jitter: the cutoff of {} Hz needs a frame rate, and the recording states none; "
        "give its rate",
        cutoff));
  if (!(cutoff >= lowest_cutoff * rate && cutoff < rate / 2))
    throw ArgumentError(
        fmt::format("jitter: cutoff is {} Hz, expected at least {} and less than half the frame "
                    "rate of {} Hz",
                    cutoff, lowest_cutoff * rate, rate));
  const LowPass low_pass(cutoff, rate);
  for (Index c = 0; c < clip.samples.cols(); ++c) low_pass.add(*noise.sd, random, c, clip.samples);
  return observed(clip);
}

Mask add_noise(const Round& noise, Random&, Recording& clip) {
  check(noise);
  for (Index f = 0; f < clip.frames(); ++f)
    for (double& x : clip.samples.row(f))
      x = std::round(x / *noise.step) * *noise.step + 0.0;  // no -0
  return observed(clip);
}

Mask add_noise(const White& noise, Random& random, Recording& clip) {
  check(noise);
  const std::optional<double> unit = noise.unit_mm ? noise.unit_mm : millimetres(clip.unit);
  if (!unit)
    throw ArgumentError(
        clip.unit.empty()
            ? "white: the recording states no unit; say how many millimetres it is with unit-mm="
            : fmt::format("white: the unit '{}' is unknown, expected mm, cm, m or ASF units; say "
                          "how many millimetres it is with unit-mm=",
                          clip.unit));
  return add_noise(Gaussian{.sd = *noise.sd_mm / *unit}, random, clip);
}

}  // namespace moclean
