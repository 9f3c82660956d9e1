#include "moclean/body/run_edges.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr double around_seconds = 0.25, usual_accelerations = 3;
constexpr double noise_of_acceleration = 3.8;  // median of |second difference| of white noise

// |second difference| about a frame; below 0 where one of the three samples was not seen.
double acceleration(const BodyTake& take, Index joint, Index frame) {
  if (frame < 1 || frame + 1 >= take.frames()) return -1;
  for (const Index i : {frame - 1, frame, frame + 1})
    if (!take.seen(i, joint)) return -1;
  return (take.position(frame - 1, joint) - 2 * take.position(frame, joint) +
          take.position(frame + 1, joint))
      .norm();
}

}  // namespace

bool has_edge(const BodyTake& take, const Mask& flags, Index joint, Index first, Index last,
              double noise) {
  const auto around = std::max<Index>(2, std::lround(around_seconds * take.frame_rate));
  std::vector<double> usual;
  const auto collect = [&](Index from, Index to) {
    for (Index i = std::max<Index>(from, 1); i < std::min(to, take.frames() - 1); ++i)
      if (const double a = acceleration(take, joint, i);
          a >= 0 && !flags.col(joint).segment(i - 1, 3).any())
        usual.push_back(a);
  };
  collect(first - 1 - around, first - 1);
  collect(last + 1, last + 1 + around);
  if (usual.empty()) return true;
  const double bound = usual_accelerations * std::max(median(usual), noise_of_acceleration * noise);
  const auto jumps = [&](Index frame) { return acceleration(take, joint, frame) > bound; };
  return jumps(first - 1) || jumps(first) || jumps(last - 1) || jumps(last);
}

}  // namespace moclean
