#include "moclean/metric/touched.hpp"

#include <cmath>

#include "moclean/metric/same_shape.hpp"

namespace moclean {
namespace {

double ratio(Index part, Index whole) {
  return static_cast<double>(part) / static_cast<double>(whole);  // 0/0 is NaN
}

}  // namespace

double rmse_where(const ConstMatrixRef& truth, const ConstMatrixRef& estimate, const Mask& mask,
                  bool claim) {
  require_same_shape(truth, estimate);
  require_mask_fits(mask, truth);
  double squares = 0;
  Index count = 0;
  for (Index f = 0; f < truth.rows(); ++f)
    for (Index c = 0; c < truth.cols(); ++c) {
      const double difference = estimate(f, c) - truth(f, c);
      if (mask(f, c) != claim || std::isnan(difference)) continue;
      squares += difference * difference;
      ++count;
    }
  return std::sqrt(squares / static_cast<double>(count));
}

double Detection::precision() const { return ratio(hits, hits + false_alarms); }
double Detection::recall() const { return ratio(hits, hits + misses); }
double Detection::f1() const { return ratio(2 * hits, 2 * hits + false_alarms + misses); }

Detection detection(const Mask& touched, const ConstMatrixRef& outliers, double threshold) {
  require_mask_fits(touched, outliers);
  Detection result;
  for (Index f = 0; f < outliers.rows(); ++f)
    for (Index c = 0; c < outliers.cols(); ++c) {
      if (std::isnan(outliers(f, c))) continue;
      const bool found = std::abs(outliers(f, c)) > threshold;
      result.hits += touched(f, c) && found;
      result.false_alarms += !touched(f, c) && found;
      result.misses += touched(f, c) && !found;
    }
  return result;
}

}  // namespace moclean
