#include "moclean/metric/strikes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "moclean/metric/same_shape.hpp"

namespace moclean {
namespace {

constexpr std::size_t peaks = 10;
constexpr double apart = 0.1;  // seconds

// The size of a joint's second difference about a frame that is neither first nor last.
double acceleration(const Recording& clip, Index frame, const Joint& joint) {
  const auto position = [&](Index f) {
    return clip.samples.row(f).segment(joint.first_column, joint.columns);
  };
  return ((position(frame - 1) - position(frame)) + (position(frame + 1) - position(frame))).norm();
}

struct Peak {
  double size = 0;
  std::size_t joint = 0;
  Index frame = 0;

  // Larger ones last; of equals the first joint and frame.
  bool operator<(const Peak& other) const {
    if (size != other.size) return size < other.size;
    return joint != other.joint ? joint > other.joint : frame > other.frame;
  }
};

std::vector<Peak> largest(const Recording& clip, const std::vector<Joint>& all) {
  std::vector<Peak> candidates, chosen;
  for (std::size_t j = 0; j < all.size(); ++j)
    for (Index f = 1; f + 1 < clip.frames(); ++f)
      if (const double size = acceleration(clip, f, all[j]); size > 0)
        candidates.push_back({size, j, f});
  std::ranges::make_heap(candidates, std::less<>());
  const auto is_near = [&](const Peak& peak) {
    return std::ranges::any_of(chosen, [&](const Peak& other) {
      const auto frames = static_cast<double>(std::abs(peak.frame - other.frame));
      return peak.joint == other.joint && frames < apart * clip.frame_rate;
    });
  };
  while (chosen.size() < peaks && !candidates.empty()) {
    std::ranges::pop_heap(candidates, std::less<>());
    if (!is_near(candidates.back())) chosen.push_back(candidates.back());
    candidates.pop_back();
  }
  return chosen;
}

}  // namespace

double strikes_kept(const Recording& truth, const Recording& estimate) {
  require_same_shape(truth.samples, estimate.samples);
  if (!(truth.frame_rate > 0)) return std::nan("");
  const std::vector<Joint> all = joints(truth);
  double sum = 0;
  Index count = 0;
  for (const Peak& peak : largest(truth, all)) {
    const double kept = acceleration(estimate, peak.frame, all[peak.joint]) / peak.size;
    if (std::isnan(kept)) continue;
    sum += kept;
    ++count;
  }
  return sum / static_cast<double>(count);  // 0/0 is NaN
}

}  // namespace moclean
