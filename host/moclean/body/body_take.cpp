#include "moclean/body/body_take.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/order_statistics.hpp"

namespace moclean {

BodyTake body_take(const Matrix& samples, double frame_rate) {
  if (samples.cols() % 3 != 0)
    throw ShapeError(
        fmt::format("{} columns are no joints of three coordinates each", samples.cols()));
  const Mask missing = samples.array().isNaN();
  BodyTake take{missing.select(0, samples), Mask(samples.rows(), samples.cols() / 3), frame_rate};
  for (Index i = 0; i < take.frames(); ++i)
    for (Index j = 0; j < take.joints(); ++j)
      take.seen(i, j) = !missing.row(i).segment<3>(3 * j).any();
  return take;
}

Index odd_frames(double seconds, double frame_rate, Index least) {
  return std::max(2 * static_cast<Index>(std::round((seconds * frame_rate - 1) / 2)) + 1, least);
}

double body_size(const BodyTake& take) {
  std::vector<double> distances, coordinate;
  for (Index i = 0; i < take.frames(); ++i) {
    Eigen::RowVector3d middle;
    for (Index c = 0; c < 3; ++c) {
      coordinate.clear();
      for (Index j = 0; j < take.joints(); ++j)
        if (take.seen(i, j)) coordinate.push_back(take.positions(i, 3 * j + c));
      if (coordinate.empty()) break;
      middle(c) = median(coordinate);
    }
    for (Index j = 0; j < take.joints(); ++j)
      if (take.seen(i, j)) distances.push_back((take.position(i, j) - middle).norm());
  }
  return distances.empty() ? 0 : median(distances);
}

std::vector<double> sampled_distances(const BodyTake& take, Index first, Index second) {
  constexpr Index enough_frames = 400;
  std::vector<double> found;
  const Index step = std::max<Index>(1, take.frames() / enough_frames);
  for (Index i = 0; i < take.frames(); i += step)
    if (take.seen(i, first) && take.seen(i, second))
      found.push_back((take.position(i, first) - take.position(i, second)).norm());
  return found;
}

}  // namespace moclean
