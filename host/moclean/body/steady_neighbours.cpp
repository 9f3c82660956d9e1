#include "moclean/body/steady_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr std::size_t fewest_distances = 20;
constexpr double tail = 0.95, deviations_of_tail = 1.96;

}  // namespace

Spreads::Spreads(const BodyTake& take)
    : take_(&take), known_(Matrix::Constant(take.joints(), take.joints(), -1)) {}

double Spreads::operator()(Index a, Index b) {
  if (known_(a, b) < 0) known_(a, b) = known_(b, a) = found(a, b);
  return known_(a, b);
}

double Spreads::found(Index a, Index b) const {
  std::vector<double> distances = sampled_distances(*take_, a, b);
  if (distances.size() <= fewest_distances) return std::numeric_limits<double>::infinity();
  const double middle = median(distances);
  for (double& d : distances) d = std::abs(d - middle);
  return quantile(distances, tail) / deviations_of_tail;
}

Neighbours steady_neighbours(const BodyTake& take, Spreads& spreads, double floor, const Gap& gap) {
  const Index first = gap.first - gap.before, last = gap.last + gap.after;
  Neighbours found;
  for (Index k = 0; k < take.joints(); ++k) {
    if (k == gap.joint || !take.seen.col(k).segment(first, last - first).all()) continue;
    const double spread = spreads(gap.joint, k);
    if (std::isfinite(spread)) found.push_back({k, 1 / (spread * spread + floor * floor)});
  }
  std::ranges::stable_sort(found, std::ranges::greater{}, &Neighbour::weight);
  return found;
}

Neighbours first_of(const Neighbours& all, std::size_t count) {
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(count, all.size()))};
}

}  // namespace moclean
