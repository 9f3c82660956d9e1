#include "moclean/body/vanished.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr double first_octave = -10, last_octave = -1.5, octave_step = 0.5;
constexpr double least_share = 0.02, largest_share = 0.7, shell_share = 0.05, margin = 1.4;
constexpr Index fewest_joints = 4;

// Whether a joint's distances from the origin have a cluster within the radius.
bool has_cluster(const std::vector<double>& distances, double radius) {
  double inside = 0, shell = 0;
  for (const double d : distances) {
    inside += d < radius;
    shell += d >= radius && d < 2 * radius;
  }
  const auto count = static_cast<double>(distances.size());
  return inside >= least_share * count && inside < largest_share * count &&
         shell < shell_share * inside;
}

std::optional<double> cluster_radius(const std::vector<std::vector<double>>& joints, double far) {
  for (double octave = first_octave; octave <= last_octave; octave += octave_step) {
    const double radius = far * std::exp2(octave);
    std::size_t clustered = 0;
    for (const auto& distances : joints) clustered += has_cluster(distances, radius);
    if (2 * clustered > joints.size()) return radius;
  }
  return {};
}

}  // namespace

Mask vanished(const BodyTake& take) {
  std::vector<std::vector<double>> joints(static_cast<std::size_t>(take.joints()));
  std::vector<double> all;
  Matrix distances(take.frames(), take.joints());
  for (Index i = 0; i < take.frames(); ++i)
    for (Index j = 0; j < take.joints(); ++j) {
      distances(i, j) = take.position(i, j).norm();
      if (!take.seen(i, j)) continue;
      joints[static_cast<std::size_t>(j)].push_back(distances(i, j));
      all.push_back(distances(i, j));
    }
  Mask lost = take.seen && distances.array() == 0;
  if (take.joints() < fewest_joints || all.empty()) return lost;
  if (const auto radius = cluster_radius(joints, median(all)))
    lost = lost || (take.seen && distances.array() < margin * *radius);
  return lost;
}

}  // namespace moclean
