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

  /// Other frames, in which neighbours and features are seen.
  struct Others {
    std::vector<RigidMotion> motions;  ///< of the neighbours
    Eigen::MatrixXd features;          ///< held still, [frames x 3 features]
  };
  Others others(const Frames& frames) const;

  /// Where the neighbours carry the joint of a gap from its edges, blended linearly, [frames x 3];
  /// `others` are the frames, of which the first are the edges.
  Matrix predicted(const Gap& gap, const Frames& frames, const Others& others) const;

 private:
  RigidMotion motion(Index frame) const;
  Eigen::RowVectorXd features_in(Index frame, const RigidMotion& motion) const;

  const BodyTake* take_;
  Neighbours near_;
  std::vector<Index> feature_joints_;
  Frames frames_;
  Eigen::MatrixXd features_at_, joint_at_;
};

/// Predicts a joint from the posture of others: its local coordinates are a linear function of
/// those of the features, by ridge regression. With a lag the function is that of differences over
/// about so many frames: for predictions whose misses at the edges of a gap will be taken out.
class PostureRegression {
 public:
  struct Ridge {
    double share;    ///< of the mean variance of a feature
    Index features;  ///< only the first so many are used
  };

  /// The postures must outlive this.
  explicit PostureRegression(const LocalPostures& postures, Index lag = 0);

  /// Appends a candidate per ridge, trained without the frames of `left_out`.
  void predict(const Gap& left_out, const LocalPostures::Others& frames,
               const std::vector<Ridge>& ridges, std::vector<Matrix>& found) const;

 private:
  Index lag_;
  Frames begins_;  // of the rows, ascending; they end at most two lags later
  Eigen::RowVectorXd feature_mean_;
  Eigen::RowVector3d mean_;
  Eigen::MatrixXd x_, y_, gram_, cross_;  // the first column of x is constant
};

}  // namespace moclean
