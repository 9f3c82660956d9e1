#include "moclean/metric/metric.hpp"

#include <cmath>

#include "moclean/core/error.hpp"
#include "moclean/metric/same_shape.hpp"

namespace moclean {
namespace {

// Statistics of the differences of some entries; NaN entries are left out.
struct Differences {
  Index compared = 0;
  Index changed = 0;
  double squares = 0;
  double largest = 0;
  Index largest_row = 0;

  double rms(Index over) const {
    return over > 0 ? std::sqrt(squares / static_cast<double>(over)) : 0;
  }
};

Differences differences(const ConstMatrixRef& truth, const ConstMatrixRef& estimate) {
  Differences result;
  for (Index f = 0; f < truth.rows(); ++f)
    for (Index c = 0; c < truth.cols(); ++c) {
      const double difference = std::abs(truth(f, c) - estimate(f, c));
      if (std::isnan(difference)) continue;
      ++result.compared;
      result.changed += difference > 0;
      result.squares += difference * difference;
      if (difference > result.largest) {
        result.largest = difference;
        result.largest_row = f;
      }
    }
  return result;
}

Differences checked_differences(const ConstMatrixRef& truth, const ConstMatrixRef& estimate) {
  require_same_shape(truth, estimate);
  const Differences result = differences(truth, estimate);
  if (result.compared == 0)
    throw ShapeError("nothing to compare: no entry is observed in both clips");
  return result;
}

}  // namespace

Comparison compare(const Recording& truth, const Recording& estimate) {
  const Differences all = checked_differences(truth.samples, estimate.samples);

  Comparison result;
  result.fd = all.rms(all.compared);
  result.changed = all.changed;
  result.rmse_changed = all.rms(all.changed);
  result.largest = all.largest;
  result.not_compared = truth.samples.size() - all.compared;
  double worst = 0;
  for (const Joint& joint : joints(truth)) {
    const Differences own =
        differences(truth.samples.middleCols(joint.first_column, joint.columns),
                    estimate.samples.middleCols(joint.first_column, joint.columns));
    const double rmse = own.rms(own.compared);
    if (rmse > worst) {
      worst = rmse;
      result.worst_joint = joint.name;
    }
    result.joints.push_back({joint.name, rmse, own.largest, own.largest_row});
  }
  return result;
}

double frobenius_distance(const ConstMatrixRef& truth, const ConstMatrixRef& estimate) {
  const Differences all = checked_differences(truth, estimate);
  return all.rms(all.compared);
}

}  // namespace moclean
