#include "moclean/body/fill_gaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "moclean/body/gap_trials.hpp"
#include "moclean/body/posture_regression.hpp"
#include "moclean/body/rigid_gap_fill.hpp"
#include "moclean/body/steady_neighbours.hpp"

namespace moclean {
namespace {

constexpr std::array<std::size_t, 3> neighbour_counts = {3, 5, 8};
constexpr std::size_t fewest_neighbours = 3, few_near = 4, many_near = 8;
constexpr Index most_features = 20;
constexpr double share_with_features = 0.6;  // of the frames a feature may not cost
constexpr std::size_t fewest_postures = 20, most_postures = 400;
constexpr std::size_t most_trials = 12, fewest_trials = 3;
constexpr Index probes_per_trial = 5;
constexpr double lag_of_gap = 0.4;
constexpr double least_variance_share = 1e-4;  // of the disagreement of candidates
constexpr double credible = 1e-6;  // least variance of a fill, over that of a steady distance
constexpr double infinite = std::numeric_limits<double>::infinity();

// Bridges gaps of fewer than `longest` frames by straight lines, so that what is missing for a
// moment still tells of joints that are missing for long.
void bridge(Index longest, BodyTake& take) {
  for (Index j = 0; j < take.joints(); ++j)
    for (Index before = -1, i = 0; i < take.frames(); ++i) {
      if (!take.seen(i, j)) continue;
      const Index lost = i - before - 1;
      if (before >= 0 && lost > 0 && lost < longest)
        for (Index k = before + 1; k < i; ++k) {
          const double share = static_cast<double>(k - before) / static_cast<double>(i - before);
          take.positions.row(k).segment<3>(3 * j) =
              (1 - share) * take.position(before, j) + share * take.position(i, j);
          take.seen(k, j) = true;
        }
      before = i;
    }
}

// Which frames can serve as trials and for training.
using Usable = std::vector<bool>;

std::size_t count_of(const Usable& some) {
  return static_cast<std::size_t>(std::ranges::count(some, true));
}

Usable with(const BodyTake& take, Usable usable, Index joint) {
  for (std::size_t i = 0; i < usable.size(); ++i)
    usable[i] = usable[i] && take.seen(static_cast<Index>(i), joint);
  return usable;
}

// Neighbours added, the steadiest first, as long as enough frames have them all.
std::vector<Index> features_of(const BodyTake& take, const Neighbours& all, Usable& usable) {
  std::vector<Index> features;
  const auto enough =
      static_cast<std::size_t>(share_with_features * static_cast<double>(count_of(usable)));
  for (const Neighbour& n : all) {
    if (std::ssize(features) == most_features) break;
    Usable fewer = with(take, usable, n.joint);
    if (count_of(fewer) < enough) continue;
    usable = std::move(fewer);
    features.push_back(n.joint);
  }
  return features;
}

Frames thinned(const Usable& usable, std::size_t most) {
  const std::size_t step = std::max<std::size_t>(1, (count_of(usable) + most - 1) / most);
  Frames found;
  std::size_t place = 0;
  for (std::size_t i = 0; i < usable.size(); ++i)
    if (usable[i] && place++ % step == 0) found.push_back(static_cast<Index>(i));
  return found;
}

// A way to fill one gap.
struct Plan {
  Predictor predict;
  FillRule rule;
};

// Learns from trials as long as the gap, or shorter ones where there are too few.
FillRule learn(const BodyTake& take, const Gap& gap, const Usable& usable,
               const Predictor& predict) {
  constexpr Index shortest = 3, share = 4;
  for (Index length = std::min(gap.frames(), static_cast<Index>(count_of(usable)) / share);
       length >= shortest; length /= 2) {
    const std::vector<Gap> some = trials(gap, length, probes_per_trial, most_trials, usable);
    if (some.size() < fewest_trials) continue;
    FillRule rule = learn_fill_rule(take, some, probes_per_trial, predict);
    rule.variance_share *=
        std::sqrt(static_cast<double>(gap.frames()) / static_cast<double>(length));
    return rule;
  }
  return {};
}

// Regressions on the posture, and carrying.
struct Regressions {
  LocalPostures few, many, world;
  PostureRegression usual, wide, moved, moved_in_world;

  Regressions(const BodyTake& take, const Gap& gap, const Neighbours& all,
              const std::vector<Index>& features, const Frames& frames)
      : few(take, gap.joint, first_of(all, few_near), features, frames),
        many(take, gap.joint, first_of(all, many_near), features, frames),
        world(take, gap.joint, {}, features, frames),
        usual(few),
        wide(many),
        moved(few, lag(gap, frames)),
        moved_in_world(world, lag(gap, frames)) {}
  Regressions(const Regressions&) = delete;
  Regressions& operator=(const Regressions&) = delete;

  static Index lag(const Gap& gap, const Frames& frames) {
    const Index span = std::min(gap.frames(), (frames.back() - frames.front()) / 4);
    return std::max<Index>(2, static_cast<Index>(lag_of_gap * static_cast<double>(span)));
  }

  Candidates predict(const Gap& gap, const Frames& frames) const {
    const LocalPostures::Others in_few = few.others(frames), in_many = many.others(frames);
    Candidates found{few.predicted(gap, frames, in_few), many.predicted(gap, frames, in_many)};
    usual.predict(gap, in_few, {{1e-5, most_features}, {1e-4, most_features}, {1e-3, 8}}, found);
    wide.predict(gap, in_many, {{1e-5, most_features}}, found);
    moved.predict(gap, in_few, {{1e-4, most_features}, {1e-2, most_features}}, found);
    moved_in_world.predict(gap, world.others(frames), {{1e-3, most_features}}, found);
    return found;
  }
};

Plan regressed(const BodyTake& take, const Gap& gap, const Neighbours& all, Usable usable) {
  if (all.size() < few_near) return {};
  for (const Neighbour& n : first_of(all, many_near)) usable = with(take, usable, n.joint);
  const std::vector<Index> features = features_of(take, all, usable);
  const Frames frames = thinned(usable, most_postures);
  if (frames.size() < fewest_postures || features.empty()) return {};
  auto regressions = std::make_shared<const Regressions>(take, gap, all, features, frames);
  Plan plan;
  plan.predict = [&take, &all, regressions](const Gap& one, const Frames& some) {
    Candidates found = regressions->predict(one, some);
    found.push_back(rigid_gap_fill(take, first_of(all, fewest_neighbours), one, some));
    return found;
  };
  plan.rule = learn(take, gap, usable, plan.predict);
  return plan;
}

Plan rigid(const BodyTake& take, const Gap& gap, const Neighbours& all, Usable usable) {
  if (all.size() < fewest_neighbours) return {};
  for (const Neighbour& n : first_of(all, neighbour_counts.back()))
    usable = with(take, usable, n.joint);
  Plan plan;
  plan.predict = [&take, &all](const Gap& one, const Frames& some) {
    Candidates found;
    for (const std::size_t count : neighbour_counts)
      if (count <= all.size())
        found.push_back(rigid_gap_fill(take, first_of(all, count), one, some));
    return found;
  };
  plan.rule = learn(take, gap, usable, plan.predict);
  return plan;
}

Plan still(const BodyTake& take, const Gap& gap, const Usable& usable) {
  Plan plan;
  plan.predict = [&take](const Gap& one, const Frames& some) {
    return Candidates{held(take, one, some)};
  };
  plan.rule = learn(take, gap, usable, plan.predict);
  return plan;
}

}  // namespace

Fills fill_gaps(BodyTake take, double floor, Index least) {
  bridge(least, take);
  const std::vector<Gap> gaps = gaps_of(take, least);
  if (gaps.empty()) return {};
  Spreads spreads(take);
  Fills fills{Matrix::Zero(take.frames(), 3 * take.joints()),
              Matrix::Constant(take.frames(), take.joints(), infinite)};
  for (const Gap& gap : gaps) {
    const Neighbours all = steady_neighbours(take, spreads, floor, gap);
    const Usable seen =
        with(take, Usable(static_cast<std::size_t>(take.frames()), true), gap.joint);
    Plan plan = regressed(take, gap, all, seen);
    if (plan.rule.empty()) plan = rigid(take, gap, all, seen);
    if (plan.rule.empty()) plan = still(take, gap, seen);
    if (plan.rule.empty()) continue;
    plan.rule.variance_share = std::max(plan.rule.variance_share, least_variance_share);
    const Matrix filled = fill(take, gap, plan.predict, plan.rule);
    if (!filled.allFinite()) continue;
    fills.positions.block(gap.first, 3 * gap.joint, gap.frames(), 3) = filled.leftCols(3);
    fills.variance.col(gap.joint).segment(gap.first, gap.frames()) =
        filled.col(3).array() + credible * floor * floor;
  }
  return fills;
}

}  // namespace moclean
