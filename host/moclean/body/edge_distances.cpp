#include "moclean/body/edge_distances.hpp"

namespace moclean {

EdgeDistances edge_distances(const BodyTake& take, std::span<const RigidEdge> edges) {
  const auto count = static_cast<Index>(edges.size());
  EdgeDistances d{Matrix(take.frames(), count), Mask(take.frames(), count)};
  for (Index i = 0; i < take.frames(); ++i)
    for (Index e = 0; e < count; ++e) {
      const RigidEdge& edge = edges[static_cast<std::size_t>(e)];
      d.both(i, e) = take.seen(i, edge.first) && take.seen(i, edge.second);
      d.values(i, e) = (take.position(i, edge.first) - take.position(i, edge.second)).norm();
    }
  return d;
}

}  // namespace moclean
