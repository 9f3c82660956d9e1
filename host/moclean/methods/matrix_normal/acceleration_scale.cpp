#include "moclean/methods/matrix_normal/acceleration_scale.hpp"

#include <cmath>

#include "moclean/methods/matrix_normal/window.hpp"

namespace moclean {
namespace {

constexpr double prior_numbers = 3, prior_per_lost = 20;  // f, and per sample that is not used
constexpr double weight_power = 0.25;                     // of the precisions; most likely 0.5

}  // namespace

Eigen::VectorXd acceleration_precision(const ConstMatrixRef& motion, const ConstMatrixRef& R,
                                       const Eigen::VectorXd& spectrum, double noise,
                                       const Mask& used, const Eigen::VectorXd& before) {
  const Index count = motion.rows() - 2;
  const Matrix a =
      motion.topRows(count) - 2 * motion.middleRows(1, count) + motion.bottomRows(count);
  const Matrix product = a * R;
  const auto columns = static_cast<double>(motion.cols());
  Eigen::VectorXd precision(count);
  for (Index k = 0; k < count; ++k) {
    const auto fewest = static_cast<double>(used.middleRows(k, 3).rowwise().count().minCoeff());
    const double prior = prior_numbers + prior_per_lost * (columns - fewest);
    double told = 0;
    for (const double power : spectrum) told += kept_power(noise, power / before(k));
    const double energy = product.row(k).dot(a.row(k));
    precision(k) = (prior + fewest / columns * told) / (prior + energy);
  }
  return precision;
}

Eigen::VectorXd acceleration_weights(const Eigen::VectorXd& precision) {
  const Eigen::VectorXd weights = precision.array().pow(weight_power);
  return weights / std::sqrt(weights.squaredNorm() / static_cast<double>(weights.size()));
}

}  // namespace moclean
