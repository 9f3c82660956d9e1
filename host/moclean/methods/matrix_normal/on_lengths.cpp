#include "moclean/methods/matrix_normal/on_lengths.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace moclean {

Mask put_on_lengths(const std::vector<DistanceLink>& links, const Mask& free, Matrix& positions) {
  constexpr int sweeps = 5;
  Mask moved = Mask::Constant(free.rows(), free.cols(), false);
  std::vector<DistanceLink> exact;
  std::ranges::copy_if(links, std::back_inserter(exact), &DistanceLink::exact);
  const auto fit = [&](Index i, const DistanceLink& link) {
    const int ends = free(i, link.first) + free(i, link.second);
    if (ends == 0) return;
    auto a = positions.row(i).segment<3>(3 * link.first);
    auto b = positions.row(i).segment<3>(3 * link.second);
    const Eigen::RowVector3d way = a - b;
    const double length = std::max(way.norm(), std::numeric_limits<double>::min());
    const Eigen::RowVector3d step = (1 - link.length / length) / ends * way;
    if (free(i, link.first)) a -= step;
    if (free(i, link.second)) b += step;
    moved(i, link.first) = moved(i, link.first) || free(i, link.first);
    moved(i, link.second) = moved(i, link.second) || free(i, link.second);
  };
  for (Index i = 0; i < free.rows(); ++i) {
    if (!free.row(i).any()) continue;
    for (int sweep = 0; sweep < sweeps; ++sweep)
      for (const DistanceLink& link : exact) fit(i, link);
  }
  return moved;
}

}  // namespace moclean
