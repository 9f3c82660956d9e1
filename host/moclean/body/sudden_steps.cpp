#include "moclean/body/sudden_steps.hpp"

#include <algorithm>
#include <cmath>

#include "moclean/core/linear_fill.hpp"
#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr double trend_seconds = 0.075, speed_seconds = 0.125, local_seconds = 0.5;
constexpr double noise_share = 8, speed_share = 0.5;

// The way of a joint where it is trusted, interpolated elsewhere.
Velocities velocities_of(const BodyTake& take, const Mask& trusted, Index joint) {
  Velocities v(take.frames() - 1, 3);
  std::vector<double> channel(static_cast<std::size_t>(take.frames()));
  Eigen::Map<Eigen::VectorXd> values(channel.data(), take.frames());
  for (Index c = 0; c < 3; ++c) {
    values = take.positions.col(3 * joint + c);
    fill_linearly(channel, trusted.col(joint));
    v.col(c) = values.tail(v.rows()) - values.head(v.rows());
  }
  return v;
}

// Whether no step can be sudden: neither a velocity nor a median of velocities is longer than the
// largest of every coordinate together.
bool is_slow(const Velocities& v, double least) {
  return 2 * v.cwiseAbs().colwise().maxCoeff().norm() < least;
}

// Running medians of every coordinate.
Velocities trend_of(const Velocities& v, double frame_rate) {
  Velocities trend = v;
  std::vector<double> channel(static_cast<std::size_t>(v.rows()));
  for (Index c = 0; c < 3; ++c) {
    Eigen::Map<Eigen::VectorXd> values(channel.data(), v.rows());
    values = v.col(c);
    running_median(channel, odd_frames(trend_seconds, frame_rate));
    trend.col(c) = values;
  }
  return trend;
}

std::vector<double> lengths(const Velocities& v) {
  std::vector<double> lengths;
  for (Index i = 0; i < v.rows(); ++i) lengths.push_back(v.row(i).norm());
  return lengths;
}

std::vector<bool> above_bound(const Velocities& rest, const Velocities& trend, double frame_rate,
                              double least) {
  const std::vector<double> length = lengths(rest), speed = lengths(trend);
  std::vector<double> local = length, sorted = length;
  running_median(local, odd_frames(local_seconds, frame_rate));
  const double usual = median(sorted) / 2;
  const auto half = static_cast<std::size_t>(odd_frames(speed_seconds, frame_rate) / 2);
  std::vector<bool> above(length.size());
  for (std::size_t i = 0; i < above.size(); ++i) {
    const auto first = speed.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, half));
    const auto last =
        speed.begin() + static_cast<std::ptrdiff_t>(std::min(above.size(), i + half + 1));
    const double bound = noise_share * std::max(local[i], usual) +
                         speed_share * *std::max_element(first, last) + least;
    above[i] = length[i] > bound;
  }
  return above;
}

}  // namespace

double least_sudden_step(double size, double smallest) {
  constexpr double size_share = 0.1, noise = 6;
  return std::max(size_share * size, noise * smallest);
}

std::vector<SuddenSteps> sudden_steps(const BodyTake& take, const Mask& trusted, double least) {
  std::vector<SuddenSteps> joints(static_cast<std::size_t>(take.joints()));
  if (take.frames() < 3) return joints;
  for (Index j = 0; j < take.joints(); ++j) {
    const Velocities v = velocities_of(take, trusted, j);
    if (is_slow(v, least)) continue;
    const Velocities trend = trend_of(v, take.frame_rate);
    SuddenSteps& steps = joints[static_cast<std::size_t>(j)];
    steps.rest = v - trend;
    steps.sudden = above_bound(steps.rest, trend, take.frame_rate, least);
  }
  return joints;
}

void forget_steps_into(Index frame, std::span<SuddenSteps> steps) {
  const auto into = static_cast<std::size_t>(frame - 1);
  for (SuddenSteps& joint : steps) {
    std::vector<bool>& sudden = joint.sudden;
    if (sudden.empty() || !sudden[into]) continue;
    std::size_t first = into, last = into;
    while (first > 0 && sudden[first - 1]) --first;
    while (last + 1 < sudden.size() && sudden[last + 1]) ++last;
    for (std::size_t i = first; i <= last; ++i) sudden[i] = false;
  }
}

}  // namespace moclean
