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
constexpr double cut = 5, broken = 0.4;  // deviations; share of frames off the centre
constexpr double bent_share = 0.05, one_sided = 0.1, gradual = 0.5, slight = 4;
constexpr int enough_hard = 2;
constexpr double hard_edge = 3, exact_edge = 0.3;  // spread, in units of the smallest

struct Pair {
  RigidEdge edge;
  bool bends = false;   // see bends()
  bool steady = false;  // not a posture that is held for half of the take
};

// Whether sorted distances pile up at the length of a straightened limb: hip and ankle of one who
// stands. Bending takes them below it, gradually and never above, whatever the third there shows.
bool bends(const std::vector<double>& sorted, double centre, double limit) {
  const auto below = [&](double d) {
    return static_cast<double>(std::ranges::lower_bound(sorted, d) - sorted.begin());
  };
  const double shorter = below(centre - limit);
  const double longer = static_cast<double>(sorted.size()) - below(centre + limit);
  const double slightly = shorter - below(centre - slight * limit);
  return shorter > bent_share * static_cast<double>(sorted.size()) &&
         longer < one_sided * shorter && slightly > gradual * shorter;
}

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
  pair.bends = bends(values, core.centre, limit);
  pair.edge.exact = core.spread < exact_edge * smallest;  // may be off: a burst in a short take
  pair.steady =
      pair.edge.exact || static_cast<double>(off) <= broken * static_cast<double>(values.size());
  pair.edge.hard = pair.steady && core.spread < hard_edge * smallest;
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

// Takes pairs that bend for rigid only where a joint has fewer than two others that are.
void soften_bending(std::vector<Pair>& pairs, Index joints) {
  std::vector<int> hard(static_cast<std::size_t>(joints), 0);
  for (const Pair& pair : pairs)
    if (pair.edge.hard && !pair.bends)
      for (const Index j : {pair.edge.first, pair.edge.second}) ++hard[static_cast<std::size_t>(j)];
  const auto has_enough = [&](Index j) { return hard[static_cast<std::size_t>(j)] >= enough_hard; };
  for (Pair& pair : pairs)
    if (pair.bends && has_enough(pair.edge.first) && has_enough(pair.edge.second))
      pair.steady = pair.edge.hard = pair.edge.exact = false;
}

// Joints at one place, a BVH file has many, say the same of any other: together as much as one.
void share_places(std::vector<Pair>& pairs, Index joints, double smallest) {
  const auto apart = [&](const Pair& pair) { return pair.edge.length >= cut * smallest; };
  std::vector<double> at_place(static_cast<std::size_t>(joints), 1);
  for (const Pair& pair : pairs)
    if (pair.edge.hard && !apart(pair))
      for (const Index j : {pair.edge.first, pair.edge.second})
        ++at_place[static_cast<std::size_t>(j)];
  for (Pair& pair : pairs)
    if (apart(pair))
      pair.edge.share = 1 / (at_place[static_cast<std::size_t>(pair.edge.first)] *
                             at_place[static_cast<std::size_t>(pair.edge.second)]);
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
  soften_bending(pairs, take.joints());
  share_places(pairs, take.joints(), smallest);
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
