#include "moclean/methods/matrix_normal/prior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr Index most_frames = 32;

Eigen::ArrayXXd distances(const ConstMatrixRef& positions, Index frame) {
  const Index joints = positions.cols() / 3;
  Eigen::ArrayXXd d = Eigen::ArrayXXd::Zero(joints, joints);
  const auto at = [&](Index j) { return positions.row(frame).segment<3>(3 * j); };
  for (Index j = 0; j < joints; ++j)
    for (Index i = 0; i < j; ++i) d(i, j) = d(j, i) = (at(i) - at(j)).norm();
  return d;
}

}  // namespace

Matrix nearness_of(const ConstMatrixRef& positions) {
  const Index joints = positions.cols() / 3, count = std::min(positions.rows(), most_frames);
  std::vector<Eigen::ArrayXXd> all;
  Eigen::ArrayXXd mean = Eigen::ArrayXXd::Zero(joints, joints);
  const auto place = [&](Index k) { return (2 * k + 1) * positions.rows() / (2 * count); };
  for (Index k = 0; k < count; ++k) {  // the same frames if played backward
    const bool second_half = 2 * k >= count;
    all.push_back(
        distances(positions, second_half ? positions.rows() - 1 - place(count - 1 - k) : place(k)));
    mean += all.back() / static_cast<double>(count);
  }
  std::vector<double> pairs;
  for (Index j = 0; j < joints; ++j)
    for (Index i = 0; i < j; ++i) pairs.push_back(mean(i, j));
  const double scale =
      pairs.empty() ? 0 : std::max(median(pairs), std::numeric_limits<double>::min());
  Eigen::ArrayXXd nearness = Eigen::ArrayXXd::Zero(joints, joints);
  for (const Eigen::ArrayXXd& d : all) nearness += (-d / scale).exp() / static_cast<double>(count);
  nearness.matrix().diagonal().setOnes();
  return nearness;
}

void draw_to_nearness(const Matrix& nearness, double share, Eigen::Ref<Matrix> q) {
  const Eigen::VectorXd deviation = q.diagonal().cwiseMax(0).cwiseSqrt();
  for (Index i = 0; i < q.rows(); ++i)
    for (Index j = i; j < q.cols(); ++j) {
      const bool same_axis = i % 3 == j % 3;
      const double prior = same_axis ? nearness(i / 3, j / 3) * deviation(i) * deviation(j) : 0;
      q(i, j) = q(j, i) = (1 - share) * q(i, j) + share * prior;
    }
}

}  // namespace moclean
