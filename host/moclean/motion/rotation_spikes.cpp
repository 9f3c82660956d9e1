#include "moclean/motion/rotation_spikes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "moclean/motion/euler_angles.hpp"

namespace moclean {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double smooth_share = 0.15;  // of the squared roughness of the joints below, that is left
constexpr Index frames_of_spike = 4;   // beside it, that it makes look unusual
constexpr double usual_quantile = 0.75;

// The channels of a bone that turn it, or that move it.
struct Track {
  std::size_t bone = 0;
  bool is_turn = true;
  std::vector<Index> channels;              // columns
  std::vector<int> axes;                    // of each
  std::optional<std::array<int, 3>> euler;  // three different axes: any rotation can be said
  double least = 0;                         // size of a spike
};

std::vector<Track> tracks_of(const Skeleton& skeleton, const RotationSpikes& parameters,
                             double size) {
  std::vector<Track> tracks;
  Index channel = 0;
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
    Track turn{.bone = b,
               .is_turn = true,
               .channels = {},
               .axes = {},
               .euler = {},
               .least = parameters.least_turn};
    Track shift{.bone = b,
                .is_turn = false,
                .channels = {},
                .axes = {},
                .euler = {},
                .least = parameters.least_shift * size};
    for (const Channel kind : skeleton.bones[b].channels) {
      Track& track = is_translation(kind) ? shift : turn;
      track.channels.push_back(channel++);
      track.axes.push_back(axis_of(kind));
    }
    std::vector<int> sorted = turn.axes;
    std::sort(sorted.begin(), sorted.end());
    if (sorted == std::vector{0, 1, 2}) turn.euler = {turn.axes[0], turn.axes[1], turn.axes[2]};
    for (Track* track : {&turn, &shift})
      if (!track->channels.empty()) tracks.push_back(std::move(*track));
  }
  return tracks;
}

double size_of(const Skeleton& skeleton) {
  std::vector<double> reach(skeleton.bones.size());
  double most = 0;
  for (std::size_t b = 0; b < reach.size(); ++b) {
    const Bone& bone = skeleton.bones[b];
    reach[b] = bone.tail.norm() + (bone.parent < 0 ? 0 : bone.offset.norm());
    if (bone.parent >= 0) reach[b] += reach[static_cast<std::size_t>(bone.parent)];
    most = std::max(most, reach[b]);
  }
  return most;
}

// A value between those at times -1, 0, t, t + 1, where that at 0 is 0.
Vector3d cubic(const Vector3d& before, const Vector3d& after, const Vector3d& beyond, double t,
               double last) {
  const std::array nodes = {-1., 0., last, last + 1};
  const auto weight = [&](std::size_t i) {
    double product = 1;
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (i != j) product *= (t - nodes[j]) / (nodes[i] - nodes[j]);
    return product;
  };
  return weight(0) * before + weight(2) * after + weight(3) * beyond;
}

Vector3d logarithm(const Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1, sine = rotation.vec().norm();
  if (sine < 1e-12) return 2 * sign * rotation.vec();
  return 2 * std::atan2(sine, sign * rotation.w()) / sine * sign * rotation.vec();
}

Quaterniond exponential(const Vector3d& turn) {
  const double angle = turn.norm();
  if (angle < 1e-12) return Quaterniond::Identity();
  return Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

// How a track goes by a run of frames.
struct Deviation {
  double size = 0;   // the largest of the run, by the smaller one of the two guesses
  double usual = 0;  // what to compare with: by the cubic guess alone
  double step = 0;   // how far the way between the neighbours is from that of their velocities
};

// The rotations or places of a track, as seen from one of its frames.
class TrackValues {
 public:
  TrackValues(const Track& track, const Matrix& channels) : track_(track) {
    turns_.resize(track.is_turn ? static_cast<std::size_t>(channels.rows()) : 0);
    places_.resize(track.is_turn ? 0 : static_cast<std::size_t>(channels.rows()));
    for (Index f = 0; f < channels.rows(); ++f) update(f, channels);
  }

  void update(Index frame, const Matrix& channels) {
    const auto f = static_cast<std::size_t>(frame);
    Quaterniond turn = Quaterniond::Identity();
    Vector3d place = Vector3d::Zero();
    for (std::size_t c = 0; c < track_.channels.size(); ++c) {
      const double value = channels(frame, track_.channels[c]);
      const Vector3d axis = Vector3d::Unit(track_.axes[c]);
      if (track_.is_turn)
        turn = turn * Quaterniond(Eigen::AngleAxisd(value, axis));
      else
        place += value * axis;
    }
    if (track_.is_turn)
      turns_[f] = turn;
    else
      places_[f] = place;
  }

  Vector3d seen_from(Index origin, Index frame) const {
    const auto o = static_cast<std::size_t>(origin), f = static_cast<std::size_t>(frame);
    return track_.is_turn ? logarithm(turns_[o].conjugate() * turns_[f]) : places_[f] - places_[o];
  }

  Deviation deviation(Index first, Index frames) const {
    const Index origin = first - 1, after = first + frames;
    const Vector3d before = seen_from(origin, origin - 1), end = seen_from(origin, after),
                   beyond = seen_from(origin, after + 1);
    const Vector3d velocity = (beyond - end - before) / 2;
    Deviation result{
        .size = 0, .usual = 0, .step = (end - static_cast<double>(frames + 1) * velocity).norm()};
    double linear = 0;
    for (Index f = first; f < after; ++f) {
      const auto t = static_cast<double>(f - origin), last = static_cast<double>(after - origin);
      const Vector3d own = seen_from(origin, f);
      result.usual = std::max(result.usual, (own - cubic(before, end, beyond, t, last)).norm());
      linear = std::max(linear, (own - t / last * end).norm());
    }
    result.size = std::min(result.usual, linear);
    return result;
  }

  // The rotation at a frame between those around the run.
  Quaterniond turn_between(Index first, Index frames, Index frame) const {
    return turns_[static_cast<std::size_t>(first - 1)] * exponential(between(first, frames, frame));
  }
  Vector3d between(Index first, Index frames, Index frame) const {
    const Index origin = first - 1, after = first + frames;
    return cubic(seen_from(origin, origin - 1), seen_from(origin, after),
                 seen_from(origin, after + 1), static_cast<double>(frame - origin),
                 static_cast<double>(after - origin));
  }

 private:
  const Track& track_;
  std::vector<Quaterniond> turns_;
  std::vector<Vector3d> places_;
};

struct Candidate {
  Index first = 0, frames = 0;
  double size = 0;
};

class SpikeSearch {
 public:
  SpikeSearch(const Skeleton& skeleton, Matrix& channels, const RotationSpikes& parameters)
      : skeleton_(skeleton), channels_(channels), parameters_(parameters) {}

  std::vector<RotationSpike> run() {
    const double size = size_of(skeleton_);
    for (const Track& track : tracks_of(skeleton_, parameters_, size)) search(track);
    return found_;
  }

 private:
  void search(const Track& track) {
    TrackValues values(track, channels_);
    std::vector<Candidate> candidates;
    for (Index length = 1; length <= parameters_.longest; ++length)
      find_candidates(track, values, length, candidates);
    // What stands beside a spike looks like a smaller one; of a spike and a longer run around it
    // the shorter comes first.
    const auto rank = [](const Candidate& run) {
      return run.size / std::cbrt(static_cast<double>(run.frames));
    };
    std::sort(candidates.begin(), candidates.end(),
              [&](const Candidate& a, const Candidate& b) { return rank(a) > rank(b); });
    for (const Candidate& candidate : candidates) {
      // Those before it may have changed what is beside it.
      const Deviation now = values.deviation(candidate.first, candidate.frames);
      if (now.size < track.least || now.size < 0.5 * candidate.size || now.size < now.step)
        continue;
      if (replace(track, values, candidate))
        found_.push_back({.bone = track.bone,
                          .first = candidate.first,
                          .frames = candidate.frames,
                          .is_turn = track.is_turn,
                          .size = candidate.size});
    }
  }

  void find_candidates(const Track& track, const TrackValues& values, Index length,
                       std::vector<Candidate>& found) const {
    constexpr Index margin = 2;
    const Index last = channels_.rows() - margin - length;
    std::vector<Deviation> all(static_cast<std::size_t>(std::max<Index>(0, last + 1)));
    for (Index f = margin; f <= last; ++f)
      all[static_cast<std::size_t>(f)] = values.deviation(f, length);
    for (Index f = margin; f <= last; ++f) {
      const Deviation& own = all[static_cast<std::size_t>(f)];
      if (!(own.size > track.least) || own.size < own.step) continue;
      const double usual = usual_around(all, margin, f, length);
      if (own.size > parameters_.ratio * usual) found.push_back({f, length, own.size});
    }
  }

  double usual_around(const std::vector<Deviation>& all, Index margin, Index frame,
                      Index length) const {
    const auto end = static_cast<Index>(all.size());
    std::vector<double> sizes;
    for (Index f = std::max(margin, frame - parameters_.around);
         f < std::min(end, frame + parameters_.around + length); ++f)
      if (f <= frame - frames_of_spike || f >= frame + length + frames_of_spike - 1)
        if (const double size = all[static_cast<std::size_t>(f)].usual; !std::isnan(size))
          sizes.push_back(size);
    if (sizes.empty()) return 1e300;
    const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(
                                           usual_quantile * static_cast<double>(sizes.size() - 1));
    std::nth_element(sizes.begin(), place, sizes.end());
    return *place;
  }

  // True if the joints below go more smoothly for it.
  bool replace(const Track& track, TrackValues& values, const Candidate& run) {
    const Matrix kept = channels_.middleRows(run.first, run.frames);
    const double before = roughness(track, run);
    for (Index f = run.first; f < run.first + run.frames; ++f) put(track, values, run, f);
    if (const double after = roughness(track, run); after > smooth_share * before) {
      channels_.middleRows(run.first, run.frames) = kept;
      return false;
    }
    for (Index f = run.first; f < run.first + run.frames; ++f) values.update(f, channels_);
    return true;
  }

  void put(const Track& track, const TrackValues& values, const Candidate& run, Index frame) {
    const Index before = run.first - 1, after = run.first + run.frames;
    if (track.euler) {
      Vector3d near;  // the way of the neighbours' angles, if they are not turns apart
      for (std::size_t c = 0; c < 3; ++c)
        near[static_cast<Index>(c)] = channels_(before, track.channels[c]);
      const Vector3d angles = euler_angles(
          values.turn_between(run.first, run.frames, frame).toRotationMatrix(), *track.euler, near);
      for (std::size_t c = 0; c < 3; ++c)
        channels_(frame, track.channels[c]) = angles[static_cast<Index>(c)];
      return;
    }
    for (const Index c : track.channels) {
      const double from = channels_(before, c);
      Vector3d one = Vector3d::Zero(), end = one, beyond = one;
      one[0] = channels_(before - 1, c) - from;
      end[0] = channels_(after, c) - from;
      beyond[0] = channels_(after + 1, c) - from;
      channels_(frame, c) = from + cubic(one, end, beyond, static_cast<double>(frame - before),
                                         static_cast<double>(after - before))[0];
    }
  }

  // Sum of the squared distances of all joints that a bone moves from places between those around
  // the run.
  double roughness(const Track& track, const Candidate& run) const {
    const Index origin = run.first - 1;
    const Matrix positions =
        forward_kinematics(skeleton_, channels_.middleRows(origin - 1, run.frames + 4));
    std::vector<bool> is_moved(skeleton_.bones.size());
    double sum = 0;
    const auto last = static_cast<double>(run.frames + 1);
    for (std::size_t b = track.bone; b < is_moved.size(); ++b) {
      const int parent = skeleton_.bones[b].parent;
      is_moved[b] = b == track.bone || (parent >= 0 && is_moved[static_cast<std::size_t>(parent)]);
      const bool stays = b == track.bone && track.is_turn && skeleton_.bones[b].tail.isZero(0);
      if (!is_moved[b] || stays) continue;
      const auto place = [&](Index row) -> Vector3d {
        return positions.row(row).segment<3>(3 * static_cast<Index>(b)).transpose();
      };
      const Vector3d from = place(1);
      for (Index f = 0; f < run.frames; ++f) {
        const Vector3d guess =
            from + cubic(place(0) - from, place(run.frames + 2) - from,
                         place(run.frames + 3) - from, static_cast<double>(f + 1), last);
        sum += (place(f + 2) - guess).squaredNorm();
      }
    }
    return sum;
  }

  const Skeleton& skeleton_;
  Matrix& channels_;
  const RotationSpikes& parameters_;
  std::vector<RotationSpike> found_;
};

}  // namespace

std::vector<RotationSpike> take_out_spikes(const Skeleton& skeleton, Matrix& channels,
                                           const RotationSpikes& parameters) {
  return SpikeSearch(skeleton, channels, parameters).run();
}

bool clean_rotations(Recording& recording, const RotationSpikes& parameters) {
  if (!recording.skeleton || recording.channels.size() == 0) return false;
  const Skeleton& skeleton = *recording.skeleton;
  const std::vector<RotationSpike> spikes =
      take_out_spikes(skeleton, recording.channels, parameters);
  const RotationSpike* largest = nullptr;
  for (const RotationSpike& spike : spikes) {
    auto frames = recording.samples.middleRows(spike.first, spike.frames);
    frames = forward_kinematics(skeleton, recording.channels.middleRows(spike.first, spike.frames));
    if (spike.is_turn && (!largest || spike.size > largest->size)) largest = &spike;
  }
  if (spikes.empty()) return true;
  std::string warning =
      fmt::format("{} spikes were taken out of the channels of the skeleton", spikes.size());
  if (largest)
    warning += fmt::format(", the largest turn {:.0f} degrees of {} in frame {}",
                           largest->size * 180 / std::numbers::pi,
                           skeleton.bones[largest->bone].name, largest->first);
  recording.notes.warnings.push_back(std::move(warning));
  return true;
}

}  // namespace moclean
