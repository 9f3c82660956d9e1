#include "moclean/noise/runs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

void check_deviation(std::string_view noise, double sd) {
  if (!(sd >= 0 && std::isfinite(sd)))
    throw ArgumentError(fmt::format("{}: sd is {}, expected at least 0", noise, sd));
}

Mask nothing_touched(const Matrix& samples) {
  return Mask::Constant(samples.rows(), samples.cols(), false);
}

// Displaces joints; share(t) of the run's vector is added in its frame t = 0, 1 ...
template <class Share>
Mask displace(std::string_view name, const Runs& runs, double sd, Random& random, Recording& clip,
              const Share& share) {
  const std::vector<Joint> all = joints(clip);
  const auto count = static_cast<Index>(all.size());
  Mask touched = nothing_touched(clip.samples);
  for (Index left = number_of_runs(name, runs, clip.frames(), count); left > 0; --left) {
    const Joint& joint = all[static_cast<std::size_t>(draw_index(random, count))];
    const Index first = draw_index(random, clip.frames() - runs.length + 1);
    for (Index c = joint.first_column; c < joint.first_column + joint.columns; ++c) {
      const double displacement = sd * random.normal();
      for (Index t = 0; t < runs.length; ++t) {
        double& x = clip.samples(first + t, c);
        if (std::isnan(x)) continue;
        x += share(t) * displacement;
        touched(first + t, c) = true;
      }
    }
  }
  return touched;
}

// Joints that may change places with one another.
std::vector<Joint> exchangeable(const Recording& clip) {
  std::vector<Joint> points, channels;
  for (const Joint& joint : joints(clip)) {
    if (joint.columns == 3) points.push_back(joint);
    for (Index c = 0; c < joint.columns; ++c)
      channels.push_back({joint.name, joint.first_column + c, 1});
  }
  if (points.size() >= 2) return points;
  if (channels.size() >= 2) return channels;
  throw ArgumentError("swap: the clip has only one column");
}

}  // namespace

void check_runs(std::string_view noise, const Runs& runs) {
  if (runs.count.has_value() == runs.fraction.has_value())
    throw ArgumentError(fmt::format("{} needs count=RUNS or fraction=SHARE, and not both", noise));
  if (runs.count && *runs.count < 0)
    throw ArgumentError(fmt::format("{}: count is {}, expected at least 0", noise, *runs.count));
  if (runs.fraction && !(*runs.fraction >= 0 && *runs.fraction <= 1))
    throw ArgumentError(fmt::format("{}: fraction is {}, expected 0 to 1", noise, *runs.fraction));
  if (runs.length < 1)
    throw ArgumentError(fmt::format("{}: length is {}, expected at least 1", noise, runs.length));
}

Index number_of_runs(std::string_view noise, const Runs& runs, Index frames, Index places) {
  if (runs.length > frames)
    throw ArgumentError(fmt::format("{}: length is {}, but the clip has only {} frames", noise,
                                    runs.length, frames));
  if (runs.count) {
    // Beyond that nothing is left that was not hit a hundred times.
    const double most = 100.0 * static_cast<double>(places) * static_cast<double>(frames) /
                        static_cast<double>(runs.length);
    if (static_cast<double>(*runs.count) > std::max(1.0, most))
      throw ArgumentError(
          fmt::format("{}: count is {}, expected at most {:.0f} for a clip of this "
                      "size",
                      noise, *runs.count, std::max(1.0, most)));
    return *runs.count;
  }
  return std::llround(*runs.fraction * static_cast<double>(places * frames) /
                      static_cast<double>(runs.length));
}

Index draw_index(Random& random, Index bound) {
  return static_cast<Index>(random.below(static_cast<std::uint64_t>(bound)));
}

void check(const Burst& noise) {
  check_runs(Burst::name, noise.runs);
  check_deviation(Burst::name, noise.sd);
}

void check(const Gap& noise) { check_runs(Gap::name, noise.runs); }

void check(const Swap& noise) { check_runs(Swap::name, noise.runs); }

void check(const Drift& noise) {
  check_runs(Drift::name, noise.runs);
  check_deviation(Drift::name, noise.sd);
}

void check(const Ramp& noise) {
  check_runs(Ramp::name, noise.runs);
  check_deviation(Ramp::name, noise.sd);
}

Mask add_noise(const Burst& noise, Random& random, Recording& clip) {
  check(noise);
  return displace(Burst::name, noise.runs, noise.sd, random, clip, [](Index) { return 1.0; });
}

Mask add_noise(const Drift& noise, Random& random, Recording& clip) {
  check(noise);
  return displace(Drift::name, noise.runs, noise.sd, random, clip, [&](Index t) {
    return static_cast<double>(t + 1) / static_cast<double>(noise.runs.length);
  });
}

Mask add_noise(const Ramp& noise, Random& random, Recording& clip) {
  check(noise);
  const Index length = noise.runs.length, rising = length / 3;
  return displace(Ramp::name, noise.runs, noise.sd, random, clip, [&](Index t) {
    const Index steps = std::min({t + 1, length - t, rising + 1});
    return static_cast<double>(steps) / static_cast<double>(rising + 1);
  });
}

Mask add_noise(const Gap& noise, Random& random, Recording& clip) {
  check(noise);
  const std::vector<Joint> all = joints(clip);
  const auto count = static_cast<Index>(all.size());
  const Mask observed = !clip.samples.array().isNaN();
  for (Index left = number_of_runs(Gap::name, noise.runs, clip.frames(), count); left > 0; --left) {
    const Joint& joint = all[static_cast<std::size_t>(draw_index(random, count))];
    const Index first = draw_index(random, clip.frames() - noise.runs.length + 1);
    clip.samples.block(first, joint.first_column, noise.runs.length, joint.columns)
        .setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return observed && clip.samples.array().isNaN();
}

Mask add_noise(const Swap& noise, Random& random, Recording& clip) {
  check(noise);
  const std::vector<Joint> all = exchangeable(clip);
  const auto count = static_cast<Index>(all.size());
  const Matrix before = clip.samples;
  for (Index left = number_of_runs(Swap::name, noise.runs, clip.frames(), count); left > 0;
       --left) {
    const Index a = draw_index(random, count);
    const Index other = draw_index(random, count - 1);
    const Joint& one = all[static_cast<std::size_t>(a)];
    const Joint& two = all[static_cast<std::size_t>(other < a ? other : other + 1)];
    const Index first = draw_index(random, clip.frames() - noise.runs.length + 1);
    for (Index f = first; f < first + noise.runs.length; ++f)
      for (Index c = 0; c < one.columns; ++c) {
        double& x = clip.samples(f, one.first_column + c);
        double& y = clip.samples(f, two.first_column + c);
        if (!std::isnan(x) && !std::isnan(y)) std::swap(x, y);
      }
  }
  return !before.array().isNaN() && clip.samples.array() != before.array();
}

}  // namespace moclean
