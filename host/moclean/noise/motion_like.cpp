#include "moclean/noise/motion_like.hpp"

#include <cmath>
#include <numbers>

#include "moclean/core/random.hpp"

namespace moclean {
namespace {

constexpr int waves = 8;

void fill_motion(Eigen::Ref<Eigen::VectorXd> column, Random& random) {
  column.setConstant(10 * random.normal());
  for (int wave = 1; wave <= waves; ++wave) {
    const double phase = 2 * std::numbers::pi * random.uniform();
    const double size = 2 * random.normal() / wave;
    for (Index f = 0; f < column.size(); ++f)
      column(f) += size * std::sin(0.01 * wave * static_cast<double>(f) + phase);
  }
}

}  // namespace

SegmentBatch motion_like(Index segments, Index frames, Index columns, std::uint64_t seed) {
  std::vector<Index> first_rows;
  for (Index b = 0; b <= segments; ++b) first_rows.push_back(b * frames);
  SegmentBatch batch(columns, first_rows);
  Random random(seed);
  Eigen::VectorXd column(frames);
  for (Index b = 0; b < segments; ++b) {
    for (Index c = 0; c < columns; ++c) {
      fill_motion(column, random);
      batch.segment(b).col(c) = column;
    }
    for (const Index f : random.choose(frames / 3, frames))
      for (Index c = 0; c < columns; ++c)
        if (random.uniform() < 0.5) batch.segment(b)(f, c) += 1 + 1.2 * random.normal();
  }
  return batch;
}

}  // namespace moclean
