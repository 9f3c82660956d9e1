#include "moclean/metric/motion_error.hpp"

#include <cmath>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/metric/same_shape.hpp"

namespace moclean {
namespace {

// A sum that leaves NaN out, and how many took part.
struct Sum {
  double total = 0;
  Index count = 0;

  void add(double value) {
    if (std::isnan(value)) return;
    total += value;
    ++count;
  }
  double mean() const { return total / static_cast<double>(count); }  // 0/0 is NaN
};

// Mean Euclidean norm of the joints' rows of `differences`.
double mean_norm(const Matrix& differences, const std::vector<Joint>& joints) {
  Sum norms;
  for (Index f = 0; f < differences.rows(); ++f)
    for (const Joint& joint : joints)
      norms.add(differences.row(f).segment(joint.first_column, joint.columns).norm());
  return norms.mean();
}

double distance(const Recording& clip, Index frame, const Joint& a, const Joint& b) {
  const auto row = clip.samples.row(frame);
  return (row.segment<3>(a.first_column) - row.segment<3>(b.first_column)).norm();
}

// Y_{f-1} - 2 Y_f + Y_{f+1}, the first and the last frame repeated.
double second_difference(const Recording& clip, Index frame, Index column) {
  const auto y = clip.samples.col(column);
  const Index before = std::max<Index>(frame - 1, 0);
  const Index after = std::min(frame + 1, clip.frames() - 1);
  return (y(before) - y(frame)) + (y(after) - y(frame));
}

}  // namespace

double position_error(const Recording& truth, const Recording& estimate) {
  require_same_shape(truth.samples, estimate.samples);
  return mean_norm(estimate.samples - truth.samples, joints(truth));
}

double worst_displacement(const Recording& truth, const Recording& estimate) {
  require_same_shape(truth.samples, estimate.samples);
  double worst = std::nan("");
  for (const Joint& joint : joints(truth))
    for (Index f = 0; f < truth.frames(); ++f) {
      const auto row = [&](const Recording& clip) {
        return clip.samples.row(f).segment(joint.first_column, joint.columns);
      };
      worst = std::fmax(worst, (row(estimate) - row(truth)).norm());  // leaves NaN out
    }
  return worst;
}

double li_position_error(const Recording& truth, const Recording& estimate) {
  require_same_shape(truth.samples, estimate.samples);
  Sum squares;
  for (Index i = 0; i < truth.samples.size(); ++i) {
    const double difference = estimate.samples.data()[i] - truth.samples.data()[i];
    squares.add(difference * difference);
  }
  return std::sqrt(squares.total) / static_cast<double>(squares.count);
}

double bone_length_error(const Recording& truth, const Recording& estimate,
                         std::span<const int> parents) {
  require_same_shape(truth.samples, estimate.samples);
  const std::vector<Joint> all = joints(truth);
  if (parents.size() != all.size())
    throw ShapeError(fmt::format("{} parents do not fit {} joints", parents.size(), all.size()));

  Sum errors;
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (parents[j] < 0) continue;
    const Joint& joint = all[j];
    const Joint& parent = all.at(static_cast<std::size_t>(parents[j]));
    if (joint.columns != 3 || parent.columns != 3) continue;
    Sum lengths;
    for (Index f = 0; f < truth.frames(); ++f) lengths.add(distance(truth, f, joint, parent));
    for (Index f = 0; f < truth.frames(); ++f)
      errors.add(std::abs(distance(estimate, f, joint, parent) - lengths.mean()));
  }
  return errors.mean();
}

double smoothness_error(const Recording& clip) {
  Sum squares;
  for (Index f = 0; f < clip.frames(); ++f)
    for (Index c = 0; c < clip.samples.cols(); ++c) {
      const double difference = second_difference(clip, f, c);
      squares.add(difference * difference);
    }
  if (squares.count == 0) return std::nan("");
  const Index rows_of_zeros = 2 * clip.samples.cols();
  return std::sqrt(squares.total) / static_cast<double>(squares.count + rows_of_zeros);
}

double acceleration_error(const Recording& truth, const Recording& estimate) {
  require_same_shape(truth.samples, estimate.samples);
  const Index inner = truth.frames() - 2;
  if (inner < 1) return std::nan("");
  const Matrix error = estimate.samples - truth.samples;
  const Matrix differences =
      error.topRows(inner) - 2 * error.middleRows(1, inner) + error.bottomRows(inner);
  return mean_norm(differences, joints(truth));
}

}  // namespace moclean
