#include "moclean/body/gaps.hpp"

#include <algorithm>

namespace moclean {

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

double place(const Gap& gap, Index frame) {
  if (gap.before && gap.after)
    return static_cast<double>(frame - gap.first + 1) / static_cast<double>(gap.frames() + 1);
  const Index away = gap.before ? frame - gap.first + 1 : gap.last - frame;
  return static_cast<double>(away) / static_cast<double>(gap.frames());
}

Frames edges(const Gap& gap) {
  Frames found;
  if (gap.before) found.push_back(gap.first - 1);
  if (gap.after) found.push_back(gap.last);
  return found;
}

Frames probes(const Gap& gap, Index count) {
  Frames found;
  count = std::min(count, gap.frames());
  for (Index c = 0; c < count; ++c)
    found.push_back(gap.first + (2 * c + 1) * gap.frames() / (2 * count));
  return found;
}

std::vector<Gap> trials(const Gap& gap, Index frames, Index probed, std::size_t most,
                        const std::vector<bool>& usable) {
  const auto count = static_cast<Index>(usable.size());
  std::vector<Index> starts;
  for (Index first = gap.before; first + frames + gap.after <= count; ++first) {
    const Gap trial{gap.joint, first, first + frames, gap.before, gap.after};
    const auto holds = [&](const Frames& some) {
      return std::ranges::all_of(some,
                                 [&](Index i) { return usable[static_cast<std::size_t>(i)]; });
    };
    if (holds(edges(trial)) && holds(probes(trial, probed))) starts.push_back(first);
  }
  std::vector<Gap> found;
  const std::size_t wanted = std::min(starts.size(), most);
  for (std::size_t t = 0; t < wanted; ++t) {
    const Index first = starts[t * (starts.size() - 1) / std::max<std::size_t>(wanted - 1, 1)];
    found.push_back({gap.joint, first, first + frames, gap.before, gap.after});
  }
  return found;
}

}  // namespace moclean
