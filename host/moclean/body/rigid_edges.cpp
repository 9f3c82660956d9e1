#include "moclean/body/rigid_edges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr std::size_t partners = 6, fewest_values = 20;
// Deviations of a normal distribution within which its central third lies.
constexpr double deviations_of_third = 0.4307;
constexpr Index fewest_joints = 4;
constexpr double broken = 0.4;  // share of frames off the centre
constexpr double bent_share = 0.05, one_sided = 0.1, gradual = 0.5, slight = 4;
constexpr int enough_hard = 2;
constexpr Index enough_frames = 400;
constexpr double turn_seconds = 0.125, enough_turn = 0.2;  // radians
constexpr double noise_of_turn = 3, weight_at_rest = 0.3;
constexpr double hard_edge = 3, exact_edge = 0.3;  // spread, in units of the smallest

struct Pair {
  RigidEdge edge;
  bool bends = false;   // see bends()
  bool steady = false;  // not a posture that is held for half of the take
};

// Distances that are looked at. A pair proves rigid by keeping its distance while it turns: a frame
// counts by how far the pair turns about it, so that a posture held for half of the take is no
// bone. A sample that is wrong for longer than that gives no weight to itself, but to those around
// it.
std::vector<WeighedDistance> weighed_distances(const BodyTake& take, Index first, Index second,
                                               double smallest) {
  const Index step = std::max<Index>(1, take.frames() / enough_frames);
  const Index around = std::max<Index>(1, std::lround(turn_seconds * take.frame_rate));
  const auto way = [&](Index i) { return take.position(i, first) - take.position(i, second); };
  const auto both = [&](Index i) { return take.seen(i, first) && take.seen(i, second); };
  std::vector<WeighedDistance> found;
  for (Index i = 0; i < take.frames(); i += step) {
    if (!both(i)) continue;
    const Index before = std::max<Index>(i - around, 0);
    const Index after = std::min(i + around, take.frames() - 1);
    const double length = way(i).norm();
    double turn = 0;
    if (both(before) && both(after))
      turn = (way(after) - way(before)).norm() - noise_of_turn * smallest;
    const double most = enough_turn * length + std::numeric_limits<double>::min();
    found.push_back({length, weight_at_rest + std::clamp(turn / most, 0., 1.)});
  }
  return found;
}

double weight_of(std::span<const WeighedDistance> distances) {
  double sum = 0;
  for (const WeighedDistance& d : distances) sum += d.weight;
  return sum;
}

// Whether sorted distances pile up at the length of a straightened limb: hip and ankle of one who
// stands. Bending takes them below it, gradually and never above, whatever the third there shows.
bool bends(std::span<const WeighedDistance> sorted, double centre, double limit) {
  const auto below = [&](double d) {
    const auto end = std::ranges::lower_bound(sorted, d, {}, &WeighedDistance::value);
    return weight_of({sorted.begin(), end});
  };
  const double all = weight_of(sorted), shorter = below(centre - limit);
  const double longer = all - below(centre + limit);
  const double slightly = shorter - below(centre - slight * limit);
  return shorter > bent_share * all && longer < one_sided * shorter && slightly > gradual * shorter;
}

// By all frames alike, and where that is not beyond doubt by how far the pair turns about them.
Pair look_at(const BodyTake& take, Index first, Index second, double smallest, bool exactly) {
  Pair pair{.edge = {.first = first, .second = second}};
  std::vector<WeighedDistance> turning = weighed_distances(take, first, second, smallest);
  std::vector<WeighedDistance> distances = turning;
  for (WeighedDistance& d : distances) d.weight = 1;
  Core core = steady_core(distances);
  pair.edge.exact = exactly && core.spread < exact_edge * smallest;  // may be off: a short take
  if (!pair.edge.exact && core.spread < hard_edge * smallest) {
    core = steady_core(turning);
    distances = std::move(turning);
  }
  pair.edge.length = core.centre;
  pair.edge.spread = core.spread;
  if (!std::isfinite(core.spread)) return pair;
  const double limit = off_deviations * std::max(core.spread, smallest);
  double off = 0;
  for (const auto& [value, weight] : distances)
    if (std::abs(value - core.centre) > limit) off += weight;
  pair.bends = bends(distances, core.centre, limit);
  pair.steady = pair.edge.exact || off <= broken * weight_of(distances);
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
  const auto apart = [&](const Pair& pair) {
    return pair.edge.length >= off_deviations * smallest;
  };
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

Core steady_core(std::vector<WeighedDistance>& distances) {
  if (distances.size() <= fewest_values) return {0, std::numeric_limits<double>::infinity()};
  std::ranges::sort(distances, {}, &WeighedDistance::value);
  const double third = weight_of(distances) / 3;
  Core core{0, std::numeric_limits<double>::infinity()};
  double held = 0;
  for (std::size_t first = 0, last = 0; last < distances.size(); ++last) {
    held += distances[last].weight;
    while (held - distances[first].weight > third) held -= distances[first++].weight;
    const double low = distances[first].value, high = distances[last].value;
    if (held <= third || high - low >= 2 * deviations_of_third * core.spread) continue;
    core = {(low + high) / 2, (high - low) / 2 / deviations_of_third};
  }
  return core;
}

Core steady_core(const std::vector<double>& distances) {
  std::vector<WeighedDistance> alike;
  for (const double d : distances) alike.push_back({d});
  return steady_core(alike);
}

RigidBody learn_rigid_body(const BodyTake& take, double smallest, double rounding) {
  const bool exactly = noise_of_distance * rounding < exact_edge * smallest;
  RigidBody body;
  body.testable.assign(static_cast<std::size_t>(take.joints()), false);
  if (take.joints() < fewest_joints) return body;
  std::vector<Pair> pairs;
  for (Index a = 0; a < take.joints(); ++a)
    for (Index b = a + 1; b < take.joints(); ++b)
      pairs.push_back(look_at(take, a, b, smallest, exactly));
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
        body.testable[static_cast<std::size_t>(j)] = true;
  const auto testable = [&](Index j) { return body.testable[static_cast<std::size_t>(j)]; };
  for (const Pair& pair : pairs) {
    if (pair.steady && (testable(pair.edge.first) || testable(pair.edge.second)))
      body.edges.push_back(pair.edge);
  }
  return body;
}

}  // namespace moclean
