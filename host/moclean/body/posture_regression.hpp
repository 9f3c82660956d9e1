#pragma once

#include <vector>

#include <Eigen/Core>

#include "moclean/body/gaps.hpp"
#include "moclean/body/local_frame.hpp"

namespace moclean {

/// A joint and others, its features, in the frames in which all are seen, as neighbours see them
/// that are held still.
class LocalPostures {
 public:
  /// Everything must be seen in `frames`, ascending and not empty. Without neighbours `near`, else
  /// at least three, nothing is held still: coordinates are those of the take.
  LocalPostures(const BodyTake& take, Index joint, Neighbours near, std::vector<Index> features,
                Frames frames);

  const Frames& frames() const { return frames_; }
  const Eigen::MatrixXd& features() const { return features_at_; }  ///< [frames x 3 features]
  const Eigen::MatrixXd& joint() const { return joint_at_; }        ///< [frames x 3]

  /// How the neighbours have moved at a frame.
  RigidMotion motion(Index frame) const;

  /// The features at a frame in which neighbours and features are seen, held still.
  Eigen::RowVectorXd features_in(Index frame, const RigidMotion& motion) const;

 private:
  const BodyTake* take_;
  Neighbours near_;
  std::vector<Index> feature_joints_;
  Frames frames_;
  Eigen::MatrixXd features_at_, joint_at_;
};

/// Positions [frames x 3] by each of several candidates.
struct Candidates {
  std::vector<Matrix> positions;
  /// Mean square of the features in standard deviations along their principal directions, per
  /// frame: about 1 in the postures of training, more where none is like it. Or empty.
  Eigen::VectorXd unlikeness;
};

/// Predicts a joint from the posture of others: its local coordinates are a linear function of
/// those of the features, by ridge regression. A ridge is a share of the mean variance of a
/// feature. With a lag the function is that of differences over about so many frames: for
/// predictions whose misses at the edges of a gap will be taken out.
class PostureRegression {
 public:
  /// The postures must outlive this. Only the first `features` are used.
  PostureRegression(const LocalPostures& postures, Index features, Index lag = 0);

  /// Appends a candidate per ridge, trained without the frames of `left_out`.
  void predict(const Gap& left_out, const Frames& frames, const std::vector<double>& ridges,
               Candidates& found) const;

 private:
  const LocalPostures* postures_;
  Index columns_, lag_;
  Frames begins_;  // of the rows, ascending; they end at most two lags later
  Eigen::RowVectorXd feature_mean_;
  Eigen::RowVector3d mean_;
  double constant_ = 0;
  Eigen::MatrixXd x_, y_, gram_, cross_;
};

}  // namespace moclean
