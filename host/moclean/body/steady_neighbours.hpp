#pragma once

#include "moclean/body/gaps.hpp"
#include "moclean/body/local_frame.hpp"

namespace moclean {

/// How steady the distances of joints are: deviations by the largest, found out when asked for.
class Spreads {
 public:
  explicit Spreads(const BodyTake& take);

  /// Infinite where two joints are hardly ever seen together.
  double operator()(Index a, Index b);

 private:
  double found(Index a, Index b) const;

  const BodyTake* take_;
  Matrix known_;
};

/// The joints seen throughout a gap and at its edges, the steadiest first, weighed by the inverse
/// square of their spread; none is steadier than `floor`.
Neighbours steady_neighbours(const BodyTake& take, Spreads& spreads, double floor, const Gap& gap);

/// The first `count`, or all.
Neighbours first_of(const Neighbours& all, std::size_t count);

}  // namespace moclean
