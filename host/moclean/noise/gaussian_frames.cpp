#include "moclean/noise/gaussian_frames.hpp"

#include <cmath>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

Index frames_touched(const GaussianFrames& noise, Index available) {
  if (noise.frames < 0) return std::llround(noise.fraction * static_cast<double>(available));
  if (noise.frames > available)
    throw ArgumentError(fmt::format(
        "gaussian-frames: frames is {}, but the clip has only {} frames", noise.frames, available));
  return noise.frames;
}

void check(const GaussianFrames& noise) {
  if (noise.frames < -1)
    throw ArgumentError(
        fmt::format("gaussian-frames: frames is {}, expected at least 0", noise.frames));
  if (!(noise.fraction >= 0 && noise.fraction <= 1))
    throw ArgumentError(
        fmt::format("gaussian-frames: fraction is {}, expected 0 to 1", noise.fraction));
  if (!(noise.sd >= 0 && std::isfinite(noise.sd)))
    throw ArgumentError(fmt::format("gaussian-frames: sd is {}, expected at least 0", noise.sd));
  if (!std::isfinite(noise.mean))
    throw ArgumentError(fmt::format("gaussian-frames: mean is {}, expected a number", noise.mean));
}

}  // namespace

GaussianFrames parse_gaussian_frames(const Specification& specification) {
  specification.allow({"frames", "fraction", "mean", "sd"});
  if (specification.has("frames") && specification.has("fraction"))
    throw ArgumentError("gaussian-frames takes frames= or fraction=, not both");
  if (!specification.has("frames") && !specification.has("fraction"))
    throw ArgumentError(
        "gaussian-frames needs frames=COUNT or fraction=SHARE, "
        "for instance gaussian-frames:frames=400");

  GaussianFrames noise;
  if (specification.has("frames")) noise.frames = specification.count("frames");
  noise.fraction = specification.number("fraction", noise.fraction);
  noise.mean = specification.number("mean", noise.mean);
  noise.sd = specification.number("sd", noise.sd);
  check(noise);
  return noise;
}

std::string to_string(const GaussianFrames& noise) {
  const std::string amount = noise.frames >= 0 ? fmt::format("frames={}", noise.frames)
                                               : fmt::format("fraction={}", noise.fraction);
  return fmt::format("gaussian-frames:{},mean={},sd={}", amount, noise.mean, noise.sd);
}

// X^ = X + G(mean, sd) .* (1 - ((U(0, 1) - 0.5) > 0)) on the chosen frames.
Mask add_noise(const GaussianFrames& noise, Random& random, Recording& clip) {
  check(noise);
  Matrix& samples = clip.samples;
  Mask touched = Mask::Constant(samples.rows(), samples.cols(), false);
  for (const Index f : random.choose(frames_touched(noise, samples.rows()), samples.rows()))
    for (Index c = 0; c < samples.cols(); ++c) {
      const double g = noise.mean + noise.sd * random.normal();
      const bool kept = random.uniform() - 0.5 > 0;
      if (kept || std::isnan(samples(f, c))) continue;
      samples(f, c) += g;
      touched(f, c) = true;
    }
  return touched;
}

}  // namespace moclean
