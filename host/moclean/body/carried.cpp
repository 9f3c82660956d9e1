#include "moclean/body/carried.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr std::array<std::size_t, 3> neighbour_counts = {3, 5, 8};
constexpr std::size_t most_trials = 12, fewest_trials = 3;
constexpr Index frames_per_trial = 5;
constexpr std::size_t fewest_distances = 20;
constexpr double tail = 0.95, deviations_of_tail = 1.96;
constexpr double infinite = std::numeric_limits<double>::infinity();

// Frames [first, last) without the joint; `before` and `after`: whether there is a frame first - 1,
// a frame last.
struct Gap {
  Index joint, first, last;
  bool before, after;

  Index frames() const { return last - first; }
  Gap moved_to(Index start) const { return {joint, start, start + frames(), before, after}; }
};

struct Neighbour {
  Index joint;
  double weight;
};
using Neighbours = std::vector<Neighbour>;

// Deviations of distances by their largest, found out when asked for; infinite where two joints are
// hardly ever seen together.
class Spreads {
 public:
  explicit Spreads(const BodyTake& take)
      : take_(take), known_(Matrix::Constant(take.joints(), take.joints(), -1)) {}

  double operator()(Index a, Index b) {
    if (known_(a, b) < 0) known_(a, b) = known_(b, a) = found(a, b);
    return known_(a, b);
  }

 private:
  double found(Index a, Index b) const {
    std::vector<double> distances = sampled_distances(take_, a, b);
    if (distances.size() <= fewest_distances) return infinite;
    const double middle = median(distances);
    for (double& d : distances) d = std::abs(d - middle);
    return quantile(distances, tail) / deviations_of_tail;
  }

  const BodyTake& take_;
  Matrix known_;
};

// From frame `from`, where the joint is seen, to frame `to`.
Eigen::RowVector3d carry_between(const BodyTake& take, Index joint, const Neighbours& neighbours,
                                 Index from, Index to) {
  Eigen::RowVector3d old_centre = Eigen::RowVector3d::Zero(), centre = old_centre;
  double total = 0;
  for (const auto& [k, weight] : neighbours) {
    old_centre += weight * take.position(from, k);
    centre += weight * take.position(to, k);
    total += weight;
  }
  old_centre /= total;
  centre /= total;
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  for (const auto& [k, weight] : neighbours)
    h += weight * (take.position(from, k) - old_centre).transpose() *
         (take.position(to, k) - centre);
  // The quaternion of the rotation is the eigenvector of the largest eigenvalue.
  Eigen::Matrix4d q;
  q(0, 0) = h.trace();
  q.bottomLeftCorner<3, 1>() << h(1, 2) - h(2, 1), h(2, 0) - h(0, 2), h(0, 1) - h(1, 0);
  q.bottomRightCorner<3, 3>() = h + h.transpose() - h.trace() * Eigen::Matrix3d::Identity();
  const Eigen::Vector4d v = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(q).eigenvectors().col(3);
  const Eigen::Quaterniond rotation(v(0), v(1), v(2), v(3));
  const Eigen::Vector3d arm = (take.position(from, joint) - old_centre).transpose();
  return centre + (rotation * arm).transpose();
}

// How far a frame of a gap is from its edges: the blend, and the profile of the variance.
double place(const Gap& gap, Index frame) {
  if (gap.before && gap.after)
    return static_cast<double>(frame - gap.first + 1) / static_cast<double>(gap.frames() + 1);
  const Index away = gap.before ? frame - gap.first + 1 : gap.last - frame;
  return static_cast<double>(away) / static_cast<double>(gap.frames());
}

double profile(const Gap& gap, double place) {
  return gap.before && gap.after ? 4 * place * (1 - place) : place;
}

Eigen::RowVector3d position_in(const BodyTake& take, const Gap& gap, const Neighbours& neighbours,
                               Index frame) {
  const auto from = [&](Index edge) {
    return carry_between(take, gap.joint, neighbours, edge, frame);
  };
  if (!gap.after) return from(gap.first - 1);
  if (!gap.before) return from(gap.last);
  const double share = place(gap, frame);
  return (1 - share) * from(gap.first - 1) + share * from(gap.last);
}

std::vector<Gap> gaps_of(const BodyTake& take, Index least) {
  std::vector<Gap> gaps;
  for (Index j = 0; j < take.joints(); ++j)
    for (Index i = 0; i < take.frames(); ++i) {
      if (take.seen(i, j)) continue;
      const Index first = i;
      while (i < take.frames() && !take.seen(i, j)) ++i;
      const Gap gap{j, first, i, first > 0, i < take.frames()};
      if (gap.frames() >= least && (gap.before || gap.after)) gaps.push_back(gap);
    }
  return gaps;
}

// Those seen in the gap and at its edges, the steadiest first.
Neighbours neighbours_of(const BodyTake& take, Spreads& spreads, double floor, const Gap& gap) {
  const Index first = gap.first - gap.before, last = gap.last + gap.after;
  Neighbours found;
  for (Index k = 0; k < take.joints(); ++k) {
    if (k == gap.joint || !take.seen.col(k).segment(first, last - first).all()) continue;
    const double spread = spreads(gap.joint, k);
    if (std::isfinite(spread)) found.push_back({k, 1 / (spread * spread + floor * floor)});
  }
  std::ranges::stable_sort(found, std::ranges::greater{}, &Neighbour::weight);
  found.resize(std::min(found.size(), neighbour_counts.back()));
  return found;
}

// Gaps of the same length at which joint and neighbours were seen throughout, all over the take.
std::vector<Gap> trials_of(const BodyTake& take, const Gap& gap, const Neighbours& neighbours) {
  const Index span = gap.frames() + gap.before + gap.after;
  std::vector<Index> starts;
  Index run = 0;
  for (Index i = 0; i < take.frames(); ++i) {
    bool seen = take.seen(i, gap.joint);
    for (const Neighbour& n : neighbours) seen = seen && take.seen(i, n.joint);
    run = seen ? run + 1 : 0;
    if (run >= span) starts.push_back(i + 1 - span + gap.before);
  }
  std::vector<Gap> trials;
  const std::size_t count = std::min(starts.size(), most_trials);
  for (std::size_t t = 0; t < count; ++t)
    trials.push_back(
        gap.moved_to(starts[t * (starts.size() - 1) / std::max<std::size_t>(count - 1, 1)]));
  return trials;
}

// Squared miss of the far edge when the joint is carried all the way across, either way.
double squared_miss(const BodyTake& take, const Gap& gap, const Neighbours& neighbours) {
  if (!gap.before || !gap.after) return 0;
  const Index a = gap.first - 1, b = gap.last;
  return (carry_between(take, gap.joint, neighbours, a, b) - take.position(b, gap.joint))
             .squaredNorm() +
         (carry_between(take, gap.joint, neighbours, b, a) - take.position(a, gap.joint))
             .squaredNorm();
}

// Variance of a coordinate where the profile is 1, from trials; more if the gap misses its edges by
// more than they do.
double trial_variance(const BodyTake& take, const Gap& gap, const Neighbours& neighbours) {
  const std::vector<Gap> trials = trials_of(take, gap, neighbours);
  if (trials.size() < fewest_trials) return infinite;
  double sum = 0, miss = 0;
  const Index count = std::min(frames_per_trial, gap.frames());
  for (const Gap& trial : trials) {
    miss += squared_miss(take, trial, neighbours);
    for (Index c = 0; c < count; ++c) {
      const Index frame = trial.first + (2 * c + 1) * trial.frames() / (2 * count);
      const Eigen::RowVector3d off =
          position_in(take, trial, neighbours, frame) - take.position(frame, gap.joint);
      sum += off.squaredNorm() / 3 / profile(trial, place(trial, frame));
    }
  }
  const auto frames = static_cast<double>(trials.size() * static_cast<std::size_t>(count));
  const double usual_miss =
      miss / static_cast<double>(trials.size()) + std::numeric_limits<double>::min();
  return std::max(1., squared_miss(take, gap, neighbours) / usual_miss) * sum / frames;
}

void carry_through(const BodyTake& take, const Gap& gap, const Neighbours& all, Carried& carried) {
  double best = infinite;
  Neighbours neighbours;
  for (const std::size_t count : neighbour_counts) {
    if (count > all.size()) break;
    const Neighbours some(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    const double variance = trial_variance(take, gap, some);
    if (variance >= best) continue;
    best = variance;
    neighbours = some;
  }
  if (neighbours.empty()) return;
  for (Index i = gap.first; i < gap.last; ++i) {
    carried.positions.row(i).segment<3>(3 * gap.joint) = position_in(take, gap, neighbours, i);
    carried.variance(i, gap.joint) = best * profile(gap, place(gap, i));
  }
}

}  // namespace

Carried carry(const BodyTake& take, double floor, Index least) {
  const std::vector<Gap> gaps = gaps_of(take, least);
  if (gaps.empty()) return {};
  Spreads spreads(take);
  Carried carried{Matrix::Zero(take.frames(), 3 * take.joints()),
                  Matrix::Constant(take.frames(), take.joints(), infinite)};
  for (const Gap& gap : gaps)
    carry_through(take, gap, neighbours_of(take, spreads, floor, gap), carried);
  return carried;
}

}  // namespace moclean
