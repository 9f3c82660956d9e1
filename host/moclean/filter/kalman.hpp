#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

/// Kalman filter and Rauch-Tung-Striebel smoother (1965) of each channel. The state is position and
/// velocity, or position, velocity and acceleration. From frame to frame it moves on by dt = 1/rate
/// and is pushed by w ~ N(0, process^2), constant over the step (Bar-Shalom, Li, Kirubarajan 2001,
/// sections 6.3.2 and 6.3.3):
///   velocity      x+ = x + v dt + w dt^2 / 2,  v+ = v + w dt
///   acceleration  x+ = x + v dt + a dt^2 / 2 + w dt^2 / 2,  v+ = v + a dt + w dt,  a+ = a + w
/// A sample is the position plus N(0, measurement^2). Past the start only the ratio of the two
/// deviations matters, so that where neither is given, the unit does not: `measurement` is a
/// thousandth of the range of the channel then, and `process` 1000 times that. Where one is given,
/// the other is 1000 or 1.
///
/// The first observed sample is the first position; velocity and acceleration start from zero with
/// a deviation that would carry them across the range of the channel in one frame, which leaves
/// them to the samples. Frames of a gap are predicted, the sides of it joined, and stay gaps.
struct KalmanSmoother {
  enum class Model { velocity, acceleration };

  Model model = Model::velocity;
  std::optional<double> process = {};      ///< deviation of w, lengths per second squared
  std::optional<double> measurement = {};  ///< deviation of a sample, in the unit of the clip

  bool operator==(const KalmanSmoother&) const = default;

  static constexpr std::string_view name = "kalman";
  static constexpr bool needs_frame_rate = true;
  static constexpr std::array<std::string_view, 2> models = {"velocity", "acceleration"};
  static void visit(auto& self, auto& visitor) {
    visitor("model", self.model, models);
    visitor("process", self.process);
    visitor("measurement", self.measurement);
  }
};

/// Throws ArgumentError for parameters out of range: 1e-100 to 1e100, which leaves room for their
/// squares.
void check(const KalmanSmoother& filter);

/// Filters one channel in place.
void smooth(const KalmanSmoother& filter, double frame_rate, std::span<double> channel);

}  // namespace moclean
