#include "moclean/noise/limbs.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

constexpr double correlation_time = 1;  // seconds, of the velocity of a drift

// Where the right-hand joint of a left-hand one stands among all, or nothing.
std::optional<std::size_t> counterpart(const std::string& name,
                                       const std::map<std::string, std::size_t>& places) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> markers = {
      {{"Left", "Right"}, {"left", "right"}, {"LEFT", "RIGHT"}, {"L", "R"}, {"l", "r"}}};
  for (const auto& [left, right] : markers)
    for (std::size_t at = name.find(left); at != name.npos; at = name.find(left, at + 1)) {
      std::string other = name;
      other.replace(at, left.size(), right);
      if (const auto found = places.find(other); found != places.end()) return found->second;
    }
  return std::nullopt;
}

std::vector<LimbPair> require_limb_pairs(std::string_view noise, const Recording& clip) {
  std::vector<LimbPair> limbs = limb_pairs(clip);
  if (limbs.empty())
    throw ArgumentError(fmt::format(
        "{}: no two joints have names that differ by left and right (Left/Right, l/r)", noise));
  return limbs;
}

// Exchanges two entries of a frame where both are observed.
void exchange(Matrix& samples, Index frame, Index one, Index two) {
  double& x = samples(frame, one);
  double& y = samples(frame, two);
  if (!std::isnan(x) && !std::isnan(y)) std::swap(x, y);
}

// The joints that drift.
std::vector<Joint> drifting(const InertialDrift& noise, Random& random, const Recording& clip) {
  std::vector<Joint> chosen;
  if (noise.of == InertialDrift::Of::body) {
    chosen = joints(clip);
  } else {
    const std::vector<LimbPair> limbs = require_limb_pairs(InertialDrift::name, clip);
    const auto drawn = random.below(2 * limbs.size());
    for (const auto& [left, right] : limbs[static_cast<std::size_t>(drawn / 2)])
      chosen.push_back(drawn % 2 == 0 ? left : right);
  }
  std::erase_if(chosen, [](const Joint& joint) { return joint.columns != 3; });
  if (chosen.empty())
    throw ArgumentError("inertial-drift: there is no joint of three columns N.x, N.y, N.z");
  return chosen;
}

// Standard deviation of the sum of n steps of correlation a, each of variance 1.
double deviation_of_sum(Index n, double a) {
  auto variance = static_cast<double>(n);
  double power = a;
  for (Index lag = 1; lag < n; ++lag, power *= a)
    variance += 2 * static_cast<double>(n - lag) * power;
  return std::sqrt(variance);
}

}  // namespace

std::vector<LimbPair> limb_pairs(const Recording& clip) {
  const std::vector<Joint> all = joints(clip);
  std::map<std::string, std::size_t> places;
  for (std::size_t j = 0; j < all.size(); ++j) places.emplace(all[j].name, j);

  std::vector<LimbPair> limbs;
  std::size_t last = 0, last_right = 0;  // of the pair before
  for (std::size_t left = 0; left < all.size(); ++left) {
    const auto right = counterpart(all[left].name, places);
    if (!right || all[left].columns != all[*right].columns) continue;
    const bool follows = left == last + 1 || (left == last + 2 && last_right == last + 1);
    if (limbs.empty() || !follows) limbs.emplace_back();
    limbs.back().emplace_back(all[left], all[*right]);
    last = left;
    last_right = *right;
  }
  return limbs;
}

void check(const LimbSwap& noise) { check_runs(LimbSwap::name, noise.runs); }

void check(const InertialDrift& noise) {
  if (!noise.sd) throw ArgumentError("inertial-drift needs sd=DEVIATION");
  if (!(*noise.sd >= 0 && std::isfinite(*noise.sd)))
    throw ArgumentError(fmt::format("inertial-drift: sd is {}, expected at least 0", *noise.sd));
}

Mask add_noise(const LimbSwap& noise, Random& random, Recording& clip) {
  check(noise);
  const std::vector<LimbPair> limbs = require_limb_pairs(LimbSwap::name, clip);
  const auto count = static_cast<Index>(limbs.size());
  const Matrix before = clip.samples;
  for (Index left = number_of_runs(LimbSwap::name, noise.runs, clip.frames(), count); left > 0;
       --left) {
    const LimbPair& limb = limbs[static_cast<std::size_t>(draw_index(random, count))];
    const Index first = draw_index(random, clip.frames() - noise.runs.length + 1);
    for (Index f = first; f < first + noise.runs.length; ++f)
      for (const auto& [one, two] : limb)
        for (Index c = 0; c < one.columns; ++c)
          exchange(clip.samples, f, one.first_column + c, two.first_column + c);
  }
  return !before.array().isNaN() && clip.samples.array() != before.array();
}

// v_0 ~ N(0, 1), v_{t+1} = a v_t + sqrt(1 - a^2) N(0, 1), a = exp(-1 / (rate tau)); the offset of
// frame t is sd times v_0 + .. + v_{t-1} over the standard deviation of the whole sum.
Mask add_noise(const InertialDrift& noise, Random& random, Recording& clip) {
  check(noise);
  if (!(clip.frame_rate > 0))
    throw ArgumentError(
        "inertial-drift needs a frame rate, and the recording states none; give its rate");
  const std::vector<Joint> chosen = drifting(noise, random, clip);
  const Matrix before = clip.samples;
  // The last bits of exp differ between platforms; those of single precision do not.
  const auto a =
      static_cast<double>(static_cast<float>(std::exp(-1 / (clip.frame_rate * correlation_time))));
  const Index steps = std::max<Index>(clip.frames() - 1, 1);
  const double scale = *noise.sd / deviation_of_sum(steps, a);
  for (Index axis = 0; axis < 3; ++axis) {
    double velocity = random.normal(), sum = 0;
    for (Index f = 0; f < clip.frames(); ++f) {
      for (const Joint& joint : chosen)
        clip.samples(f, joint.first_column + axis) += scale * sum;  // NaN stays NaN
      sum += velocity;
      velocity = a * velocity + std::sqrt(1 - a * a) * random.normal();
    }
  }
  return !before.array().isNaN() && clip.samples.array() != before.array();
}

}  // namespace moclean
