#include "moclean/noise/gaussian.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

void require_ratio(std::string_view noise, double snr) {
  if (!(std::abs(snr) <= 300))
    throw ArgumentError(fmt::format("{}: snr is {}, expected -300 to 300 dB", noise, snr));
}

// Sum of the squares of the observed entries of a column about their mean. Plain loops: Eigen's
// sums depend on the width of the machine's vectors.
double squares_about_mean(const Matrix& samples, Index column, Index& count) {
  double sum = 0;
  Index observed = 0;
  for (Index f = 0; f < samples.rows(); ++f) {
    if (std::isnan(samples(f, column))) continue;
    sum += samples(f, column);
    ++observed;
  }
  if (observed == 0) return 0;
  const double mean = sum / static_cast<double>(observed);
  double squares = 0;
  for (Index f = 0; f < samples.rows(); ++f) {
    const double x = samples(f, column) - mean;
    if (!std::isnan(x)) squares += x * x;
  }
  count += observed;
  return squares;
}

void add_gaussian(double sd, Random& random, Matrix& samples) {
  for (Index f = 0; f < samples.rows(); ++f)
    for (double& x : samples.row(f)) x += sd * random.normal();  // NaN stays NaN
}

}  // namespace

void check(const Gaussian& noise) {
  if (noise.sd.has_value() == noise.snr.has_value())
    throw ArgumentError("gaussian needs sd=DEVIATION or snr=DECIBEL, and not both");
  if (noise.sd && !(*noise.sd >= 0 && std::isfinite(*noise.sd)))
    throw ArgumentError(fmt::format("gaussian: sd is {}, expected at least 0", *noise.sd));
  if (noise.snr) require_ratio("gaussian", *noise.snr);
}

void check(const Dropout& noise) {
  if (!(noise.fraction >= 0 && noise.fraction <= 1))
    throw ArgumentError(fmt::format("dropout: fraction is {}, expected 0 to 1", noise.fraction));
  require_ratio("dropout", noise.snr);
}

double deviation_of(double snr, const Matrix& samples) {
  double squares = 0;
  Index count = 0;
  for (Index c = 0; c < samples.cols(); ++c) squares += squares_about_mean(samples, c, count);
  if (count == 0) return 0;
  // The last bits of pow differ between platforms; those of single precision do not.
  const auto ratio = static_cast<double>(static_cast<float>(std::pow(10.0, -snr / 20)));
  return ratio * std::sqrt(squares / static_cast<double>(count));
}

Mask add_noise(const Gaussian& noise, Random& random, Recording& clip) {
  check(noise);
  const double sd = noise.sd ? *noise.sd : deviation_of(*noise.snr, clip.samples);
  add_gaussian(sd, random, clip.samples);
  return !clip.samples.array().isNaN();
}

Mask add_noise(const Dropout& noise, Random& random, Recording& clip) {
  check(noise);
  Matrix& samples = clip.samples;
  const std::vector<Joint> all = joints(clip);
  const auto count = static_cast<Index>(all.size());
  const Index dropped = std::llround(noise.fraction * static_cast<double>(count));
  const double value =
      noise.fill == Dropout::Fill::zero ? 0.0 : std::numeric_limits<double>::quiet_NaN();
  const Mask observed = !samples.array().isNaN();
  if (noise.background == Dropout::Background::gaussian)
    add_gaussian(deviation_of(noise.snr, samples), random, samples);

  Mask touched = Mask::Constant(samples.rows(), samples.cols(), false);
  for (Index f = 0; f < samples.rows(); ++f)
    for (const Index j : random.choose(dropped, count)) {
      const Joint& joint = all[static_cast<std::size_t>(j)];
      for (Index c = joint.first_column; c < joint.first_column + joint.columns; ++c) {
        if (!observed(f, c)) continue;
        samples(f, c) = value;
        touched(f, c) = true;
      }
    }
  return touched;
}

}  // namespace moclean
