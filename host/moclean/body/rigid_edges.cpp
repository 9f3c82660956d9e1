#include "moclean/body/rigid_edges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr std::size_t partners = 6, fewest_values = 20;
// Deviations of a normal distribution within which its central third lies.
constexpr double deviations_of_third = 0.4307;
constexpr Index fewest_joints = 4;
constexpr double cut = 5, broken = 0.4;            // deviations; share of frames off the centre
constexpr double hard_edge = 3, exact_edge = 0.3;  // spread, in units of the smallest

struct Pair {
  RigidEdge edge;
  bool steady = false;  // not a posture that is held for half of the take
};

Pair look_at(const BodyTake& take, Index first, Index second, double smallest) {
  Pair pair{.edge = {.first = first, .second = second}};
  std::vector<double> values = sampled_distances(take, first, second);
  const Core core = steady_core(values);
  pair.edge.length = core.centre;
  pair.edge.spread = core.spread;
  if (!std::isfinite(core.spread)) return pair;
  const double limit = cut * std::max(core.spread, smallest);
  const auto off =
      std::ranges::count_if(values, [&](double d) { return std::abs(d - core.centre) > limit; });
  const bool exact = core.spread < exact_edge * smallest;  // may be off: a burst in a short take
  pair.steady = exact || static_cast<double>(off) <= broken * static_cast<double>(values.size());
  pair.edge.hard = pair.steady && core.spread < hard_edge * smallest;
  pair.edge.exact = exact;
  return pair;
}

// Per joint the spread of its sixth steadiest pair.
std::vector<double> partner_bounds(const std::vector<Pair>& pairs, Index joints) {
  std::vector<std::vector<double>> spreads(static_cast<std::size_t>(joints));
  for (const Pair& pair : pairs)
    for (const Index j : {pair.edge.first, pair.edge.second})
      spreads[static_cast<std::size_t>(j)].push_back(pair.edge.spread);
  std::vector<double> bounds;
  for (auto& own : spreads) {
    const std::size_t place = std::min(partners, own.size()) - 1;
    std::ranges::nth_element(own, own.begin() + static_cast<std::ptrdiff_t>(place));
    bounds.push_back(own[place]);
  }
  return bounds;
}

}  // namespace

bool RigidBody::is_rigid() const {
  return std::ranges::any_of(edges, [](const RigidEdge& e) { return e.hard; });
}

Core steady_core(std::vector<double>& values) {
  if (values.size() <= fewest_values) return {0, std::numeric_limits<double>::infinity()};
  std::ranges::sort(values);
  const std::size_t third = (values.size() + 2) / 3;
  std::size_t best = 0;
  for (std::size_t k = 1; k + third < values.size(); ++k)
    if (values[k + third] - values[k] < values[best + third] - values[best]) best = k;
  const double low = values[best], high = values[best + third];
  return {(low + high) / 2, (high - low) / 2 / deviations_of_third};
}

RigidBody learn_rigid_body(const BodyTake& take, double smallest) {
  RigidBody body;
  body.judged.assign(static_cast<std::size_t>(take.joints()), false);
  if (take.joints() < fewest_joints) return body;
  std::vector<Pair> pairs;
  for (Index a = 0; a < take.joints(); ++a)
    for (Index b = a + 1; b < take.joints(); ++b) pairs.push_back(look_at(take, a, b, smallest));
  const std::vector<double> bounds = partner_bounds(pairs, take.joints());
  std::erase_if(pairs, [&](const Pair& pair) {
    const RigidEdge& e = pair.edge;
    return !std::isfinite(e.spread) ||
           e.spread > std::max(bounds[static_cast<std::size_t>(e.first)],
                               bounds[static_cast<std::size_t>(e.second)]);
  });
  for (const Pair& pair : pairs)
    if (pair.edge.hard)
      for (const Index j : {pair.edge.first, pair.edge.second})
        body.judged[static_cast<std::size_t>(j)] = true;
  const auto judged = [&](Index j) { return body.judged[static_cast<std::size_t>(j)]; };
  for (const Pair& pair : pairs) {
    if (pair.steady && (judged(pair.edge.first) || judged(pair.edge.second)))
      body.edges.push_back(pair.edge);
  }
  return body;
}

}  // namespace moclean
