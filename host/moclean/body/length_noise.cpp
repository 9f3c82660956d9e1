#include "moclean/body/length_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "moclean/body/rigid_edges.hpp"
#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr double far_off = 4;         // deviations
constexpr double shortest_bone = 5;   // deviations: what is closer has no length to speak of
constexpr double longest_lag = 0.25;  // seconds
constexpr double stretch = 0.25;      // seconds
constexpr double calm_share = 0.1, calm_power = 0.6;
constexpr double least_correlation = 1.5, hidden = 2, least_share = 8e-3;
constexpr double most_share = 0.1, most_lasting = 0.2;
constexpr double same_share = 0.05;  // of steps without any change
constexpr std::size_t fewest_pairs = 8, fewest_stretches = 4;
constexpr double fewest_frames = 20;

// The two joints of a length and its core.
struct Bone {
  Index first = 0, second = 0;
  Core core = {0, std::numeric_limits<double>::infinity()};

  bool operator==(const Bone& other) const {
    return first == other.first && second == other.second;
  }
};

// Every joint with the neighbour of the steadiest distance, each pair once.
std::vector<Bone> steadiest_bones(const BodyTake& take) {
  std::vector<Bone> own(static_cast<std::size_t>(take.joints())), bones;
  for (Index a = 0; a < take.joints(); ++a)
    for (Index b = a + 1; b < take.joints(); ++b) {
      std::vector<double> values = sampled_distances(take, a, b);
      const Core core = steady_core(values);
      if (!(core.centre > shortest_bone * core.spread)) continue;
      for (const Index j : {a, b})
        if (Bone& best = own[static_cast<std::size_t>(j)]; core.spread < best.core.spread)
          best = {a, b, core};
    }
  for (const Bone& bone : own)
    if (std::isfinite(bone.core.spread) && std::ranges::find(bones, bone) == bones.end())
      bones.push_back(bone);
  return bones;
}

// What a length has beside its mean, [frames]; 0 where it is not known or far off.
struct Rest {
  Eigen::ArrayXd values, known;  // known: 1 or 0

  double covariance(Index lag) const {
    const Index count = values.size() - lag;
    const double pairs = (known.head(count) * known.tail(count)).sum();
    return pairs > 0 ? (values.head(count) * values.tail(count)).sum() / pairs : 0;
  }

  // Mean squared change from frame to frame in `count` steps; negative if half are not known.
  double change(Index first, Index count) const {
    const auto both = known.segment(first, count) * known.segment(first + 1, count);
    const auto steps = values.segment(first + 1, count) - values.segment(first, count);
    const double steps_known = both.sum();
    if (2 * steps_known < static_cast<double>(count)) return -1;
    return (both * steps.square()).sum() / steps_known;
  }

  // Whether the length often stays exactly the same: samples on a lattice.
  bool lingers() const {
    double same = 0, all = 0;
    for (Index i = 0; i + 1 < values.size(); ++i) {
      if (known(i) == 0 || known(i + 1) == 0) continue;
      same += values(i) == values(i + 1);
      ++all;
    }
    return same > same_share * all;
  }
};

double length_in(const Matrix& positions, Index frame, const Bone& bone) {
  const auto row = positions.row(frame);
  return (row.segment<3>(3 * bone.first) - row.segment<3>(3 * bone.second)).norm();
}

std::optional<Rest> rest_of(const BodyTake& take, const Bone& bone) {
  Rest rest{Eigen::ArrayXd::Zero(take.frames()), Eigen::ArrayXd::Zero(take.frames())};
  for (Index i = 0; i < take.frames(); ++i) {
    if (!take.seen(i, bone.first) || !take.seen(i, bone.second)) continue;
    const double off = length_in(take.positions, i, bone) - bone.core.centre;
    if (std::abs(off) > far_off * bone.core.spread) continue;
    rest.values(i) = off;
    rest.known(i) = 1;
  }
  if (rest.known.sum() < fewest_frames) return {};
  rest.values -= rest.known * (rest.values.sum() / rest.known.sum());
  return rest;
}

// Spectral density at frequency 0.
double slow_variance(const Rest& rest, Index longest) {
  double all = rest.covariance(0);
  for (Index lag = 1; lag <= std::min(longest, rest.values.size() - 1); ++lag) {
    const double covariance = rest.covariance(lag);
    if (covariance <= 0) break;
    all += 2 * covariance;
  }
  return all;
}

// Whether the lengths change in calm stretches nearly as much as in others.
bool change_always(const std::vector<Rest>& rests, Index length) {
  const auto lingering = std::ranges::count_if(rests, &Rest::lingers);
  if (2 * lingering > std::ssize(rests)) return false;
  const Index steps = rests.front().values.size() - 1;
  std::vector<double> means;
  for (const Rest& rest : rests) means.push_back(rest.change(0, steps));
  std::vector<double> powers;
  for (Index first = 0; first + length <= steps; first += length) {
    double sum = 0, count = 0;
    for (std::size_t k = 0; k < rests.size(); ++k) {
      const double change = rests[k].change(first, length);
      if (change < 0 || means[k] <= 0) continue;
      sum += change / means[k];
      ++count;
    }
    if (count > 0) powers.push_back(sum / count);
  }
  return powers.size() >= fewest_stretches && quantile(powers, calm_share) >= calm_power;
}

// The largest correlation of lengths with themselves `first` to 4 `first` frames later, the median
// over the lengths: motion lasts, or comes back with the next step.
double lasting(const std::vector<Rest>& rests, Index first) {
  const Index last = std::min(4 * first, rests.front().values.size() - 1);
  double most = 0;
  for (Index lag = first; lag <= last; ++lag) {
    std::vector<double> correlations;
    for (const Rest& rest : rests) {
      const double now = rest.covariance(0);
      correlations.push_back(now > 0 ? rest.covariance(lag) / now : 1);
    }
    most = std::max(most, std::abs(median(correlations)));
  }
  return most;
}

}  // namespace

bool LengthNoise::correlated(double size, double dense) const {
  return steady && slow > least_correlation * deviation && deviation > hidden * dense &&
         deviation > least_share * size && deviation < most_share * size && lasting < most_lasting;
}

LengthNoise length_noise(const BodyTake& take) {
  const auto frames_in = [&](double seconds) {
    return std::max<Index>(3, std::lround(seconds * take.frame_rate));
  };
  std::vector<Rest> rests;
  std::vector<double> samples, slow;
  for (const Bone& bone : steadiest_bones(take)) {
    auto rest = rest_of(take, bone);
    if (!rest) continue;
    samples.push_back(rest->covariance(0) / 2);  // of two ends
    slow.push_back(slow_variance(*rest, frames_in(longest_lag)) / 2);
    rests.push_back(std::move(*rest));
  }
  if (rests.size() < fewest_pairs) return {};
  return {std::sqrt(median(samples)), std::sqrt(median(slow)),
          change_always(rests, frames_in(stretch)), lasting(rests, frames_in(longest_lag))};
}

double worthwhile_share(const BodyTake& take, const Matrix& motion) {
  std::vector<double> taken;
  for (const Bone& bone : steadiest_bones(take)) {
    const auto rest = rest_of(take, bone);
    if (!rest) continue;
    Eigen::ArrayXd left(take.frames());
    for (Index i = 0; i < take.frames(); ++i) left(i) = length_in(motion, i, bone);
    const double mean = (rest->known * left).sum() / rest->known.sum();
    const Eigen::ArrayXd away = rest->known * (rest->values - (left - mean));
    taken.push_back((rest->values * away).sum() / rest->known.sum() / 2);
  }
  double way = 0;
  for (Index j = 0; j < take.joints(); ++j)
    for (Index i = 0; i < take.frames(); ++i)
      if (take.seen(i, j))
        way += (motion.row(i).segment<3>(3 * j) - take.position(i, j)).squaredNorm();
  if (taken.empty() || way == 0) return 1;
  way /= 3 * static_cast<double>(take.seen.count());
  return std::clamp(median(taken) / way, 0., 1.);
}

}  // namespace moclean
