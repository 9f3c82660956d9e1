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
    joint_at_.row(i) = motion.moved_back(take.position(frame, joint));
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
    found.segment<3>(column) = motion.moved_back(take_->position(frame, k));
    column += 3;
  }
  return found;
}

LocalPostures::Others LocalPostures::others(const Frames& frames) const {
  Others found;
  found.features.resize(static_cast<Index>(frames.size()), features_at_.cols());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    found.motions.push_back(motion(frames[i]));
    found.features.row(static_cast<Index>(i)) = features_in(frames[i], found.motions.back());
  }
  return found;
}

Matrix LocalPostures::predicted(const Gap& gap, const Frames& frames, const Others& others) const {
  std::vector<Eigen::RowVector3d> at_edges;
  for (const Index edge : edges(gap))
    at_edges.push_back(
        others.motions[at_edges.size()].moved_back(take_->position(edge, gap.joint)));
  Matrix found(static_cast<Index>(frames.size()), 3);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double late = gap.before && gap.after ? place(gap, frames[i]) : 0;
    const Eigen::RowVector3d local = (1 - late) * at_edges.front() + late * at_edges.back();
    found.row(static_cast<Index>(i)) = others.motions[i].moved(local);
  }
  return found;
}

PostureRegression::PostureRegression(const LocalPostures& postures, Index lag)
    : lag_(lag),
      feature_mean_(postures.features().colwise().mean()),
      mean_(postures.joint().colwise().mean()) {
  const Frames& frames = postures.frames();
  const Eigen::MatrixXd& x = postures.features();
  x_.resize(x.rows(), x.cols() + 1);
  y_.resize(x.rows(), 3);
  Index rows = 0;
  for (std::size_t i = 0; i < frames.size(); ++i, ++rows) {
    const auto a = static_cast<Index>(i);
    begins_.push_back(frames[i]);
    if (lag_ == 0) {
      x_.row(rows).tail(x.cols()) = x.row(a) - feature_mean_;
      y_.row(rows) = postures.joint().row(a) - mean_;
      continue;
    }
    const auto later = std::lower_bound(frames.begin() + a, frames.end(), frames[i] + lag_);
    if (later == frames.end()) break;
    const auto b = static_cast<Index>(later - frames.begin());
    const double taken = *later <= frames[i] + 2 * lag_;
    x_.row(rows).tail(x.cols()) = taken * (x.row(b) - x.row(a));
    y_.row(rows) = taken * (postures.joint().row(b) - postures.joint().row(a));
  }
  x_.conservativeResize(rows, Eigen::NoChange);
  y_.conservativeResize(rows, Eigen::NoChange);
  begins_.resize(static_cast<std::size_t>(rows));
  gram_ = Eigen::MatrixXd::Zero(x_.cols(), x_.cols());
  cross_ = Eigen::MatrixXd::Zero(x_.cols(), 3);
  if (rows == 0) return;
  // The constant takes up the means of what is left in. Differences have none.
  x_.col(0).setConstant(
      lag_ > 0 ? 0 : x_.rightCols(x.cols()).norm() / std::sqrt(static_cast<double>(rows)));
  gram_.selfadjointView<Eigen::Lower>().rankUpdate(x_.transpose());
  cross_.noalias() = x_.transpose() * y_;
}

void PostureRegression::predict(const Gap& left_out, const LocalPostures::Others& frames,
                                const std::vector<Ridge>& ridges,
                                std::vector<Matrix>& found) const {
  const auto begin = std::ranges::lower_bound(begins_, left_out.first - 2 * lag_);
  const auto end = std::ranges::lower_bound(begins_, left_out.last);
  const Index first = begin - begins_.begin(), count = end - begin;
  Eigen::MatrixXd gram = gram_, cross = cross_;
  if (count > 0) {
    const auto x = x_.middleRows(first, count);
    gram.selfadjointView<Eigen::Lower>().rankUpdate(x.transpose(), -1);
    cross.noalias() -= x.transpose() * y_.middleRows(first, count);
  }
  for (const auto& [share, features] : ridges) {
    const Index columns = 1 + std::min(3 * features, gram.cols() - 1);
    Eigen::MatrixXd regular = gram.topLeftCorner(columns, columns);
    regular.diagonal().array() +=
        share * regular.diagonal().tail(columns - 1).mean() + std::numeric_limits<double>::min();
    const Eigen::MatrixXd weights =
        Eigen::LLT<Eigen::MatrixXd>(regular).solve(cross.topRows(columns));
    Matrix local =
        (frames.features.leftCols(columns - 1).rowwise() - feature_mean_.head(columns - 1)) *
        weights.bottomRows(columns - 1);
    const Eigen::RowVector3d constant = mean_ + (x_.rows() > 0 ? x_(0, 0) : 0) * weights.row(0);
    for (Index i = 0; i < local.rows(); ++i)
      local.row(i) = frames.motions[static_cast<std::size_t>(i)].moved(local.row(i) + constant);
    found.push_back(std::move(local));
  }
}

}  // namespace moclean
