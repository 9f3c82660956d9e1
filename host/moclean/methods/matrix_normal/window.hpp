#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "moclean/core/matrix.hpp"
#include "moclean/methods/matrix_normal/matrix_normal.hpp"
#include "moclean/solve/motion_prior.hpp"

namespace moclean {

/// What the steps of MatrixNormal do to one window beside its linear algebra, for the device form:
/// statistics, weights, noise. The reference has them in a text of its own
/// (methods/matrix_normal/reference_model.hpp), which says whether this one is right. A step is
///   A = accelerations(S), times growth() if there is one;   add_prior(A'A) = Z' diag(e) Z
///   R = Z' diag(inverse_spectrum(e)) Z, about Q^-1
///   weigh(S, R)
///   S = argmin sum weights() (target() - S)^2 + tr(P Delta S R (Delta S)'), P = diag precision()
///   estimate_noise(S)
/// and the results come last. Matrices are [rows x columns]; a window shorter than it is wide is
/// extended by frames without samples until rows = columns, which leaves the minimiser as it is.
class MatrixNormalWindow {
 public:
  /// `data` is [frames x columns], NaN where missing. `method` and `prior` outlive the window.
  MatrixNormalWindow(const ConstMatrixRef& data, const MatrixNormal& method,
                     const MotionPrior& prior);

  Index frames() const { return frames_; }
  Index rows() const { return data_.rows(); }
  Index columns() const { return data_.cols(); }
  int steps() const { return method_->soft_steps + method_->hard_steps; }

  /// Nothing to learn accelerations from: fewer than five frames, or no sample at all.
  bool trivial() const { return frames_ < 5 || observed_.sum() == 0; }

  /// What comes out of a trivial window: D, gaps where nothing is expected filled linearly.
  Matrix filled() const;

  /// What S begins as: `motion` is the data's running medians, gaps filled linearly, smoothed with
  /// weights 1 and R = diag(stiffness): each column for its own ratio of noise to acceleration.
  struct FirstGuess {
    Matrix motion;
    Eigen::VectorXd stiffness;
  };
  FirstGuess first_guess() const;

  /// Delta S, the last two rows zero. In soft steps every column is clipped at five robust
  /// deviations; in hard ones rows have acceleration_weights()
  /// (methods/matrix_normal/acceleration_scale.hpp).
  Matrix accelerations(const ConstMatrixRef& motion) const;

  /// Weights per eigenvector of the Q of the step before: A is multiplied by Z' diag(growth) Z to
  /// undo what smoothing took from it. Empty where noise does not matter yet.
  std::optional<Eigen::VectorXd> growth() const;

  /// A'A, of which the upper triangle is read, with the prior that joints near each other move
  /// alike. The less is known of the accelerations, the more.
  void add_prior(Eigen::Ref<Matrix> square) const;

  /// 1 / (e + ridge), given the eigenvalues of that.
  Eigen::VectorXd inverse_spectrum(const Eigen::VectorXd& eigenvalues);

  /// Precisions from the accelerations, weights and targets from the residuals.
  void weigh(const ConstMatrixRef& motion, const ConstMatrixRef& R);

  /// Of the rows of Delta S; 0 of the last two, which are none.
  const Eigen::VectorXd& precision() const { return precision_; }

  const Matrix& weights() const { return solve_weights_; }  ///< W / v
  const Matrix& target() const { return target_; }          ///< D; in gaps, where lengths say
  bool target_changed() const { return target_changed_; }   ///< by weigh(), or not yet asked for

  /// sigma from the residuals; ends the step.
  void estimate_noise(const ConstMatrixRef& motion);

  /// The motion that comes out, [frames x columns]: S, but D where it is trusted if there is no
  /// noise to speak of; NaN in columns without any sample.
  Matrix cleaned(const ConstMatrixRef& motion) const;

  /// D - `cleaned` where a sample was observed and not trusted, else 0; [frames x columns].
  Matrix rejected(const ConstMatrixRef& cleaned) const;

  /// Samples that were trusted in the last step, [frames x columns].
  Mask trusted() const;

  /// Standard deviation of the cleaned motion, [frames x columns], given S and the eigenvectors of
  /// the last step's A'A in rows: methods/matrix_normal/deviation.hpp. NaN in columns without any
  /// sample, and where there was no step.
  Matrix deviation(const ConstMatrixRef& motion, const ConstMatrixRef& eigenvectors) const;

 private:
  // A missing sample of which the prior knows.
  struct PriorSample {
    Index row, column;
    double variance;
    double weight;  // share of the precision with which it counts
  };

  bool confirmed(Index frame, Index column) const {
    return prior_->confirmed.size() > 0 &&
           prior_->confirmed(frame, column / method_->joint_columns);
  }
  bool hard() const { return step_ >= method_->soft_steps; }
  double share_kept() const;
  double least_spectrum() const;
  std::optional<Eigen::VectorXd> kept() const;
  std::vector<double> filled(Index j) const;
  Matrix all_filled() const;
  void leave_unobserved(Matrix& result) const;
  Matrix energies(const ConstMatrixRef& motion) const;
  void weigh_softly(const Matrix& energy);
  void weigh_hard(const Matrix& energy, const ConstMatrixRef& motion);
  void find_prior_samples();
  void find_prior_samples(Index j, Index first, Index last);
  void add_prior_samples();
  void build_on_lengths(const ConstMatrixRef& motion);
  std::vector<double> residuals(const ConstMatrixRef& motion) const;

  const MatrixNormal* method_;
  const MotionPrior* prior_;
  Index frames_;
  Matrix data_, observed_;  // D also holds prior samples
  Mask present_;            // observed, or a prior sample
  std::vector<PriorSample> prior_samples_;
  Matrix nearness_;                   // of joints; empty where columns are no joints
  double noise_floor_, least_noise_;  // least sigma: of the data's size, and what rounding makes
  double sigma_;
  int step_ = 0;
  Matrix confidence_;                        // c: the variance of a sample's noise is sigma^2 / c
  Matrix weights_, solve_weights_, target_;  // W [frames x columns], W / v, D or a prior
  bool target_changed_ = true;
  Eigen::VectorXd precision_;              // [rows]
  Eigen::VectorXd spectrum_, predictive_;  // e of this step's Q with its ridge; 1 / R_jj
};

/// Added to the weights in the preconditioner, share of the mean of diag R: keeps columns without
/// samples definite.
inline constexpr double least_preconditioner_weight = 1e-9;

/// Share of the acceleration power in a direction of variance `power` that smoothing keeps under
/// white noise of variance `noise`: the mean over frequencies w of
/// 1 / (1 + noise / power (2 - 2 cos w)^2), which is Re (1 + 4 i sqrt(noise / power))^-1/2, that is
/// sqrt((1 + 1 / q) / 2 q) with q = sqrt(1 + 16 noise / power).
double kept_power(double noise, double power);

}  // namespace moclean
