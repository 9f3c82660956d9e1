#include "moclean/methods/matrix_normal/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

// The finite ones among `values`.
std::vector<double> observed_of(const auto& values) {
  std::vector<double> found;
  for (const double x : values)
    if (!std::isnan(x)) found.push_back(x);
  return found;
}

// x, y, z, each at least their median.
void raise_to_median(double& x, double& y, double& z) {
  const double low = std::min(x, y), high = std::max(x, y);
  const double middle = std::max(low, std::min(high, z));
  x = std::max(x, middle);
  y = std::max(y, middle);
  z = std::max(z, middle);
}

}  // namespace

double column_scale(const ConstMatrixRef& data) {
  std::vector<double> spreads;
  double largest = std::numeric_limits<double>::min();
  for (Index j = 0; j < data.cols(); ++j) {
    std::vector<double> values = observed_of(data.col(j));
    if (values.empty()) continue;
    const double middle = median(values);
    for (double& x : values) {
      largest = std::max(largest, std::abs(x));
      x = std::abs(x - middle);
    }
    spreads.push_back(median(values));
  }
  const double scale = spreads.empty() ? 0 : 3 * deviation_per_mad * median(spreads);
  return scale > 0 ? scale : largest;
}

double dense_noise_level(const ConstMatrixRef& data) {
  // The lower quartile of |x| of a standard normal x; sum of the squared binomials 1 4 6 4 1.
  constexpr double quartile = 0.3186, squares = 70;
  std::vector<double> differences;
  differences.reserve(static_cast<std::size_t>(data.size()));
  for (Index i = 0; i + 4 < data.rows(); ++i)
    for (Index j = 0; j < data.cols(); ++j) {
      const double d = data(i, j) - 4 * data(i + 1, j) + 6 * data(i + 2, j) - 4 * data(i + 3, j) +
                       data(i + 4, j);
      if (!std::isnan(d)) differences.push_back(std::abs(d));
    }
  if (differences.size() <= 50) return 0;
  return quantile(differences, 0.25) / quartile / std::sqrt(squares);
}

Matrix gap_distance(const ConstMatrixRef& weights) {
  constexpr double in_use = 0.3;
  constexpr double beyond_end = 3;
  using Row = Eigen::Array<double, 1, Eigen::Dynamic>;
  const Index frames = weights.rows();
  Matrix h(frames, weights.cols());
  // First the distance to the sample before, then both together.
  const Row end = Row::Constant(weights.cols(), beyond_end + 1);
  Row away = end;
  const auto next = [&](Index i) { away = (weights.row(i).array() > in_use).select(1, away + 1); };
  for (Index i = 0; i < frames; ++i) {
    h.row(i) = away;
    next(i);
  }
  away = end;
  for (Index i = frames - 1; i >= 0; --i) {
    auto row = h.row(i).array();
    row = 2 * row * away / (row + away);
    next(i);
  }
  return h;
}

void raise_to_joint_median(Matrix& energies, Index joint_columns) {
  if (joint_columns == 1) return;
  std::vector<double> joint;
  for (Index i = 0; i < energies.rows(); ++i)
    for (Index j = 0; j < energies.cols(); j += joint_columns) {
      auto entries = energies.row(i).segment(j, std::min(joint_columns, energies.cols() - j));
      if (entries.size() == 3) {
        raise_to_median(entries(0), entries(1), entries(2));
        continue;
      }
      joint.assign(entries.begin(), entries.end());
      entries = entries.cwiseMax(median(joint));
    }
}

}  // namespace moclean
