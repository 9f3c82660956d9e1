// Notation: X features, Y the joint, G = X'X, B = X'Y, W = (G + r tr(G) / n I)^-1 B.
#include "moclean/body/posture_regression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

namespace moclean {

LocalPostures::LocalPostures(const BodyTake& take, Index joint, Neighbours near,
                             std::vector<Index> features, Frames frames)
    : take_(&take),
      near_(std::move(near)),
      feature_joints_(std::move(features)),
      frames_(std::move(frames)) {
  const auto rows = static_cast<Index>(frames_.size());
  features_at_.resize(rows, 3 * static_cast<Index>(feature_joints_.size()));
  joint_at_.resize(rows, 3);
  for (Index i = 0; i < rows; ++i) {
    const Index frame = frames_[static_cast<std::size_t>(i)];
    const RigidMotion motion = this->motion(frame);
    features_at_.row(i) = features_in(frame, motion);
    joint_at_.row(i) = motion.carried_back(take.position(frame, joint));
  }
}

RigidMotion LocalPostures::motion(Index frame) const {
  if (near_.empty())
    return {Eigen::Matrix3d::Identity(), Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero()};
  return rigid_motion(*take_, near_, frames_.front(), frame);
}

Eigen::RowVectorXd LocalPostures::features_in(Index frame, const RigidMotion& motion) const {
  Eigen::RowVectorXd found(3 * static_cast<Index>(feature_joints_.size()));
  Index column = 0;
  for (const Index k : feature_joints_) {
    found.segment<3>(column) = motion.carried_back(take_->position(frame, k));
    column += 3;
  }
  return found;
}

PostureRegression::PostureRegression(const LocalPostures& postures, Index features, Index lag)
    : postures_(&postures),
      columns_(3 * features),
      lag_(lag),
      feature_mean_(postures.features().leftCols(3 * features).colwise().mean()),
      mean_(postures.joint().colwise().mean()) {
  const Frames& frames = postures.frames();
  const auto x = postures.features().leftCols(columns_);
  x_.resize(x.rows(), columns_ + 1);
  y_.resize(x.rows(), 3);
  Index rows = 0;
  for (std::size_t i = 0; i < frames.size(); ++i, ++rows) {
    const auto a = static_cast<Index>(i);
    begins_.push_back(frames[i]);
    if (lag_ == 0) {
      x_.row(rows).head(columns_) = x.row(a) - feature_mean_;
      y_.row(rows) = postures.joint().row(a) - mean_;
      continue;
    }
    const auto later = std::lower_bound(frames.begin() + a, frames.end(), frames[i] + lag_);
    if (later == frames.end()) break;
    const auto b = static_cast<Index>(later - frames.begin());
    const double taken = *later <= frames[i] + 2 * lag_;
    x_.row(rows).head(columns_) = taken * (x.row(b) - x.row(a));
    y_.row(rows) = taken * (postures.joint().row(b) - postures.joint().row(a));
  }
  x_.conservativeResize(rows, Eigen::NoChange);
  y_.conservativeResize(rows, Eigen::NoChange);
  begins_.resize(static_cast<std::size_t>(rows));
  gram_ = Eigen::MatrixXd::Zero(columns_ + 1, columns_ + 1);
  cross_ = Eigen::MatrixXd::Zero(columns_ + 1, 3);
  if (rows == 0) return;
  // One more feature, a constant, takes up the means of what is left in.
  if (lag_ == 0) constant_ = x_.leftCols(columns_).norm() / std::sqrt(static_cast<double>(rows));
  x_.col(columns_).setConstant(constant_);
  gram_.selfadjointView<Eigen::Lower>().rankUpdate(x_.transpose());
  cross_.noalias() = x_.transpose() * y_;
}

void PostureRegression::predict(const Gap& left_out, const Frames& frames,
                                const std::vector<double>& ridges, Candidates& found) const {
  const auto begin = std::ranges::lower_bound(begins_, left_out.first - 2 * lag_);
  const auto end = std::ranges::lower_bound(begins_, left_out.last);
  const Index first = begin - begins_.begin(), count = end - begin;
  Eigen::MatrixXd gram = gram_, cross = cross_;
  if (count > 0) {
    const auto x = x_.middleRows(first, count);
    gram.selfadjointView<Eigen::Lower>().rankUpdate(x.transpose(), -1);
    cross.noalias() -= x.transpose() * y_.middleRows(first, count);
  }
  const double variance =
      gram.diagonal().head(columns_).mean() + std::numeric_limits<double>::min();
  const auto rows = static_cast<Index>(frames.size());
  std::vector<RigidMotion> motions;
  Eigen::MatrixXd x(rows, columns_ + 1);
  x.col(columns_).setConstant(constant_);
  for (Index i = 0; i < rows; ++i) {
    motions.push_back(postures_->motion(frames[static_cast<std::size_t>(i)]));
    x.row(i).head(columns_) =
        postures_->features_in(frames[static_cast<std::size_t>(i)], motions.back()).head(columns_) -
        feature_mean_;
  }
  for (const double ridge : ridges) {
    Eigen::MatrixXd regular = gram;
    regular.diagonal().array() += ridge * variance;
    const Eigen::LLT<Eigen::MatrixXd> cholesky(regular);
    Matrix local = x * cholesky.solve(cross);
    local.rowwise() += mean_;
    for (Index i = 0; i < rows; ++i)
      local.row(i) = motions[static_cast<std::size_t>(i)].carried(local.row(i).eval());
    found.positions.push_back(std::move(local));
    if (lag_ > 0 || found.unlikeness.size() > 0) continue;
    const Eigen::MatrixXd scaled = cholesky.matrixL().solve(x.transpose());
    found.unlikeness = scaled.colwise().squaredNorm().transpose() *
                       (static_cast<double>(x_.rows() - count) / static_cast<double>(columns_));
  }
}

}  // namespace moclean
