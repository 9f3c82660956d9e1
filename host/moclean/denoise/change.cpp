#include "moclean/denoise/change.hpp"

#include <algorithm>
#include <cmath>

#include "moclean/body/vanished.hpp"

namespace moclean {
namespace {

// Size of the body whose joints are those of three columns.
double size_of(const std::vector<Joint>& all, const Matrix& motion, double frame_rate) {
  std::vector<Index> first;
  for (const Joint& joint : all)
    if (joint.columns == 3) first.push_back(joint.first_column);
  Matrix positions(motion.rows(), 3 * static_cast<Index>(first.size()));
  for (std::size_t j = 0; j < first.size(); ++j)
    positions.middleCols<3>(3 * static_cast<Index>(j)) = motion.middleCols<3>(first[j]);
  BodyTake body = body_take(positions, frame_rate);
  const std::vector<bool> still = still_joints(body);
  for (std::size_t j = 0; j < still.size(); ++j)
    if (still[j]) body.seen.col(static_cast<Index>(j)).setConstant(false);
  return body_size(body);
}

// How far the observed columns of a joint were moved in each frame.
Eigen::ArrayXd moved(const Matrix& samples, const Matrix& motion, const Joint& joint) {
  const auto was = samples.middleCols(joint.first_column, joint.columns);
  const auto is = motion.middleCols(joint.first_column, joint.columns);
  const Matrix step = is - was;
  const Eigen::ArrayXd distance = step.array().isNaN().select(0, step).matrix().rowwise().norm();
  const auto at_origin = (was.array() == 0).rowwise().all();
  return at_origin.select(0, distance);
}

}  // namespace

Change change_of(const Recording& take, const Matrix& motion, const StatusCounts& counts) {
  const auto share = [&](SampleStatus status) {
    return static_cast<double>(counts[static_cast<std::size_t>(status)]) /
           static_cast<double>(std::max<Index>(1, take.samples.size()));
  };
  Change change{.corrected = share(SampleStatus::corrected), .filled = share(SampleStatus::filled)};
  const std::vector<Joint> all = joints(take);
  for (const Joint& joint : all) {
    Index frame = 0;
    const double distance = moved(take.samples, motion, joint).maxCoeff(&frame);
    if (distance > change.largest.distance) change.largest = {distance, joint.name, frame};
  }
  change.body_size = size_of(all, motion, take.frame_rate);
  return change;
}

}  // namespace moclean
