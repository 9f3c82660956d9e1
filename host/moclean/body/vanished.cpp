#include "moclean/body/vanished.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "moclean/body/rigid_edges.hpp"
#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr double first_octave = -10, last_octave = -1.5, octave_step = 0.5;
constexpr double least_share = 0.02, largest_share = 0.7, shell_share = 0.05, margin = 1.4;
constexpr Index fewest_joints = 4;
constexpr double usual_steps = 0.9, jump = 2;  // quantile of a joint's steps; times that
constexpr double constant = 1e-2, holds = 5, least_limit = 1e-3;  // share; deviations; share
constexpr int witnesses = 2;

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

// Zeros under noise, in which every joint that is not still takes part.
void add_cluster(const BodyTake& take, const std::vector<bool>& still, Mask& lost) {
  std::vector<std::vector<double>> joints;
  std::vector<double> all;
  for (Index j = 0; j < take.joints(); ++j) {
    if (still[static_cast<std::size_t>(j)]) continue;
    std::vector<double>& distances = joints.emplace_back();
    for (Index i = 0; i < take.frames(); ++i)
      if (take.seen(i, j)) distances.push_back(take.position(i, j).norm());
    all.insert(all.end(), distances.begin(), distances.end());
  }
  if (static_cast<Index>(joints.size()) < fewest_joints || all.empty()) return;
  const auto radius = cluster_radius(joints, median(all));
  if (!radius) return;
  for (Index j = 0; j < take.joints(); ++j)
    for (Index i = 0; i < take.frames() && !still[static_cast<std::size_t>(j)]; ++i)
      lost(i, j) = lost(i, j) || (take.seen(i, j) && take.position(i, j).norm() < margin * *radius);
}

// The step from the origin, or to it, that is a jump of joint j, given where it is `elsewhere`;
// infinite if it is at the origin for most of the time.
double smallest_jump(const BodyTake& elsewhere, Index zeros, Index j) {
  std::vector<double> steps;
  Index before = -1;
  for (Index i = 0; i < elsewhere.frames(); ++i) {
    if (!elsewhere.seen(i, j)) continue;
    if (before >= 0)
      steps.push_back((elsewhere.position(i, j) - elsewhere.position(before, j)).norm());
    before = i;
  }
  if (elsewhere.seen.col(j).count() < zeros) return std::numeric_limits<double>::infinity();
  return steps.empty() ? 0 : jump * quantile(steps, usual_steps);
}

// The runs of zeros of joint j that begin and end with a jump, as far as they have a beginning and
// an end.
void find_jumps(const BodyTake& elsewhere, const Mask& zero, Index j, Mask& lost) {
  const double least = smallest_jump(elsewhere, zero.col(j).count(), j);
  const auto is_far = [&](Index i) { return i < 0 || elsewhere.position(i, j).norm() > least; };
  Index before = -1, first = -1;
  const auto close = [&](Index last, bool jumps_back) {
    if (first >= 0 && jumps_back && is_far(before))
      lost.col(j).segment(first, last - first) = zero.col(j).segment(first, last - first);
    first = -1;
  };
  for (Index i = 0; i < elsewhere.frames(); ++i)
    if (zero(i, j) && first < 0) {
      first = i;
    } else if (elsewhere.seen(i, j)) {
      close(i, is_far(i));
      before = i;
    }
  close(elsewhere.frames(), true);
}

// Takes those zeros of joint j back that are where the other joints expect it.
void spare_present(const BodyTake& elsewhere, const std::vector<bool>& still, Index j, Mask& lost) {
  Eigen::ArrayXi votes = Eigen::ArrayXi::Zero(lost.rows()), against = votes;
  for (Index k = 0; k < elsewhere.joints(); ++k) {
    if (k == j || still[static_cast<std::size_t>(k)]) continue;
    std::vector<double> usual = sampled_distances(elsewhere, j, k);
    const Core core = steady_core(usual);
    if (!(core.spread <= constant * core.centre)) continue;
    const double limit = std::max(holds * core.spread, least_limit * core.centre);
    for (Index i = 0; i < lost.rows(); ++i)
      if (lost(i, j) && elsewhere.seen(i, k)) {
        const double off = elsewhere.position(i, k).norm() - core.centre;
        ++(std::abs(off) <= limit ? votes : against)(i);
      }
  }
  lost.col(j) = lost.col(j) && !(votes >= witnesses && votes > against);
}

}  // namespace

std::vector<bool> still_joints(const BodyTake& take) {
  std::vector<bool> still(static_cast<std::size_t>(take.joints()), false);
  for (Index j = 0; j < take.joints(); ++j) {
    Index first = -1;
    bool moves = false;
    for (Index i = 0; i < take.frames() && !moves; ++i) {
      if (!take.seen(i, j)) continue;
      if (first < 0) first = i;
      moves = take.position(i, j) != take.position(first, j);
    }
    still[static_cast<std::size_t>(j)] = first >= 0 && !moves;
  }
  return still;
}

Mask vanished(const BodyTake& take) {
  const std::vector<bool> still = still_joints(take);
  Mask zero(take.frames(), take.joints());
  for (Index j = 0; j < take.joints(); ++j)
    for (Index i = 0; i < take.frames(); ++i)
      zero(i, j) = take.seen(i, j) && (take.position(i, j).array() == 0).all();
  BodyTake elsewhere = take;
  elsewhere.seen = take.seen && !zero;
  Mask lost = Mask::Constant(take.frames(), take.joints(), false);
  for (Index j = 0; j < take.joints(); ++j) {
    if (still[static_cast<std::size_t>(j)] || !zero.col(j).any()) continue;
    find_jumps(elsewhere, zero, j, lost);
    if (lost.col(j).any()) spare_present(elsewhere, still, j, lost);
  }
  add_cluster(take, still, lost);
  return lost;
}

}  // namespace moclean
