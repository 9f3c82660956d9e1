// Notation: D data, S motion, W weights, v variance of a sample, Q covariance of the accelerations
// with eigenvalues e, R about Q^-1; see methods/matrix_normal/matrix_normal.hpp.
#include "moclean/methods/matrix_normal/window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "moclean/core/linear_fill.hpp"
#include "moclean/core/order_statistics.hpp"
#include "moclean/methods/matrix_normal/acceleration_scale.hpp"
#include "moclean/methods/matrix_normal/deviation.hpp"
#include "moclean/methods/matrix_normal/on_lengths.hpp"
#include "moclean/methods/matrix_normal/prior.hpp"
#include "moclean/methods/matrix_normal/rounding_step.hpp"
#include "moclean/methods/matrix_normal/statistics.hpp"

namespace moclean {
namespace {

constexpr double soft_ridge = 2e-2, hard_ridge = 1e-3;  // share of the mean eigenvalue of Q
constexpr double least_prior = 10, noise_prior = 50;    // frames that the prior of Q counts for
constexpr double noise_floor_share = 1.25e-5;  // least sigma of the hard steps, of the size
constexpr double noise_to_scale = 10;     // least sigma to tell scales of accelerations, of that
constexpr double soft_floor_share = 0.1;  // of the soft ones, of that
constexpr double dense_noise = 10. / 6;   // sigma^2 over mean e from which smoothing is undone
constexpr double most_stiffness = 1e3;
constexpr double learned_weight = 0.3;  // least weight of samples that scales are learned from
constexpr double clip_deviations = 5, near_deviations = 3;
// Of prior samples: the errors in a gap are one slow curve, and in a short one S knows better.
constexpr double prior_weight_per_lag = 0.03, most_prior_weight = 0.3;
constexpr double length_weight = 0.1, length_distance = 4;  // of joints put on lengths; frames
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

double square(double x) { return x * x; }

// Variance of what samples at the harmonic distance h predict, 1 / R_jj being 1: a second
// difference between neighbours, a random walk of velocities over a gap.
double open_variance(double h) { return std::max(h / 6, h * h * h / 24); }

}  // namespace

double kept_power(double noise, double power) {
  const double q = std::sqrt(1 + 16 * noise / power);
  return std::sqrt((1 + 1 / q) / (2 * q));
}

MatrixNormalWindow::MatrixNormalWindow(const ConstMatrixRef& data, const MatrixNormal& method,
                                       const MotionPrior& prior)
    : method_(&method), prior_(&prior), frames_(data.rows()) {
  const Index rows = std::max(data.rows(), data.cols());
  const Mask seen = !data.array().isNaN();
  data_ = Matrix::Zero(rows, data.cols());
  data_.topRows(frames_) = seen.select(data, 0);
  observed_ = seen.cast<double>();
  const double size = prior_->size > 0 ? prior_->size : column_scale(data);
  noise_floor_ = noise_floor_share * size;
  least_noise_ = std::max(rounding_deviation(data), prior_->noise);
  sigma_ = std::max({dense_noise_level(data), least_noise_, soft_floor_share * noise_floor_});
  weights_ = observed_;
  confidence_ =
      prior.confidence.size() > 0 ? prior.confidence : Matrix::Ones(frames_, columns()).eval();
  precision_ = Eigen::VectorXd::Ones(rows);
  precision_.tail(std::min<Index>(rows, 2)).setZero();
  find_prior_samples();
  target_ = data_;
  if (method.joint_columns == 3 && columns() % 3 == 0 && !trivial())
    nearness_ = nearness_of(all_filled());
}

void MatrixNormalWindow::find_prior_samples() {
  present_ = observed_.array() > 0;
  if (prior_->positions.size() == 0) return;
  for (Index j = 0; j < columns(); ++j)
    for (Index i = 0; i < frames_; ++i) {
      const Index first = i;
      while (i < frames_ && observed_(i, j) <= 0) ++i;
      find_prior_samples(j, first, i);
    }
}

// Those of a gap.
void MatrixNormalWindow::find_prior_samples(Index j, Index first, Index last) {
  const double lags = static_cast<double>(last - first) / static_cast<double>(method_->lag_frames);
  const double weight = std::min(prior_weight_per_lag * lags, most_prior_weight);
  for (Index i = first; i < last; ++i) {
    const double variance = prior_->variance(i, j / method_->joint_columns);
    if (!std::isfinite(variance)) continue;
    prior_samples_.push_back({i, j, variance, weight});
    present_(i, j) = true;
    data_(i, j) = prior_->positions(i, j);
  }
}

// Second differences over a lag of h frames tell the acceleration under dense noise: their variance
// is 6 sigma^2 + h^4 q. Without dense noise the stiffness is 1.
MatrixNormalWindow::FirstGuess MatrixNormalWindow::first_guess() const {
  FirstGuess guess{data_, Eigen::VectorXd::Ones(columns())};
  const Index h = std::min(method_->lag_frames, (frames_ - 1) / 2), count = frames_ - 2 * h;
  std::vector<double> lags;
  for (Index j = 0; j < columns(); ++j) {
    std::vector<double> channel = filled(j);
    const Eigen::Map<Eigen::VectorXd> values(channel.data(), frames_);
    const Eigen::ArrayXd lag =
        (values.head(count) - 2 * values.segment(h, count) + values.tail(count)).array().abs();
    lags.assign(lag.begin(), lag.end());
    const double power = square(deviation_per_mad * median(lags)) - 6 * square(sigma_);
    const double q = std::max(power, 0.0) / std::pow(h, 4) + std::numeric_limits<double>::min();
    guess.stiffness(j) = std::clamp(square(sigma_) / q, 1.0, most_stiffness);
    running_median(channel, method_->median_frames);
    for (Index i = 0; i < frames_; ++i) guess.motion(i, j) = values(i);
    guess.motion.col(j).tail(rows() - frames_).setConstant(values(frames_ - 1));
  }
  return guess;
}

Matrix MatrixNormalWindow::accelerations(const ConstMatrixRef& motion) const {
  const Index count = frames_ - 2;
  Matrix a = Matrix::Zero(rows(), columns());
  a.topRows(count) =
      motion.topRows(count) - 2 * motion.middleRows(1, count) + motion.middleRows(2, count);
  if (hard()) {
    a.topRows(count) = acceleration_weights(precision_.head(count)).asDiagonal() * a.topRows(count);
    return a;
  }
  std::vector<double> magnitudes(static_cast<std::size_t>(count));
  Eigen::Map<Eigen::ArrayXd> sizes(magnitudes.data(), count);
  for (Index j = 0; j < columns(); ++j) {
    auto column = a.col(j).head(count);
    sizes = column.array().abs();
    const double middle = deviation_per_mad * median(magnitudes);
    const double spread =
        std::sqrt(column.array().min(6 * middle).max(-6 * middle).square().mean());
    const double bound = clip_deviations * std::max(middle, spread / 2);
    column = column.array().min(bound).max(-bound);
  }
  return a;
}

double MatrixNormalWindow::share_kept() const {
  return std::max(weights_.cwiseProduct(confidence_).mean(), 1e-3);
}

double MatrixNormalWindow::least_spectrum() const {
  const double least = hard() ? 1e-5 * spectrum_.mean() : 1e-9 * spectrum_.maxCoeff();
  return least + std::numeric_limits<double>::min();
}

// Share of the power that smoothing left per eigenvector of the Q of the step before, where noise
// matters.
std::optional<Eigen::VectorXd> MatrixNormalWindow::kept() const {
  if (step_ == 0) return {};
  const double variance = square(sigma_), least = least_spectrum();
  if (!hard() && variance <= dense_noise * spectrum_.mean()) return {};
  const double noise = hard() ? variance / share_kept() : variance;
  return spectrum_.unaryExpr([&](double e) { return kept_power(noise, std::max(e, least)); });
}

std::optional<Eigen::VectorXd> MatrixNormalWindow::growth() const {
  std::optional<Eigen::VectorXd> kept = this->kept();
  if (kept) *kept = kept->cwiseSqrt().cwiseInverse();
  return kept;
}

// The frames tell of a direction as much as smoothing left of it.
void MatrixNormalWindow::add_prior(Eigen::Ref<Matrix> square) const {
  if (nearness_.size() == 0) return;
  const std::optional<Eigen::VectorXd> kept = this->kept();
  const double share = kept ? kept->mean() : 1;
  const double known = static_cast<double>(frames_ - 2) * share_kept() * share;
  const double prior = least_prior + noise_prior * (1 - share);
  draw_to_nearness(nearness_, prior / (prior + known), square);
}

Eigen::VectorXd MatrixNormalWindow::inverse_spectrum(const Eigen::VectorXd& eigenvalues) {
  const Eigen::VectorXd e = eigenvalues.cwiseMax(0) / static_cast<double>(frames_ - 2);
  const double ridge = (hard() ? hard_ridge : soft_ridge) * e.mean();
  spectrum_ = e.array() + ridge + square(soft_floor_share * noise_floor_);
  return spectrum_.cwiseInverse();
}

// Squared residuals in predictive deviations: the larger of the entry's own and the median of its
// joint's.
Matrix MatrixNormalWindow::energies(const ConstMatrixRef& motion) const {
  Matrix energy = gap_distance(weights_);
  for (Index i = 0; i < frames_; ++i)
    for (Index j = 0; j < columns(); ++j) {
      const double variance =
          square(sigma_) / confidence_(i, j) + energy(i, j) * predictive_(j) / 6;
      energy(i, j) = observed_(i, j) * square(data_(i, j) - motion(i, j)) / variance;
    }
  raise_to_joint_median(energy, method_->joint_columns);
  return energy;
}

void MatrixNormalWindow::weigh(const ConstMatrixRef& motion, const ConstMatrixRef& R) {
  predictive_ = R.diagonal().cwiseInverse();
  if (hard() && sigma_ > noise_to_scale * noise_floor_)
    precision_.head(frames_ - 2) =
        acceleration_precision(motion.topRows(frames_), R, spectrum_, square(sigma_) / share_kept(),
                               weights_.array() > learned_weight, precision_.head(frames_ - 2));
  else
    precision_.head(frames_ - 2).setOnes();
  const Matrix energy = energies(motion);
  solve_weights_ = Matrix::Zero(rows(), columns());
  target_changed_ = step_ == 0;
  if (hard())
    weigh_hard(energy, motion);
  else
    weigh_softly(energy);
  add_prior_samples();
}

// Missing samples where they should be, as samples of their variance.
void MatrixNormalWindow::add_prior_samples() {
  for (const PriorSample& sample : prior_samples_) {
    const double weight = sample.weight / (square(sigma_) + sample.variance);
    double& all = solve_weights_(sample.row, sample.column);
    double& target = target_(sample.row, sample.column);
    target = (all * target + weight * data_(sample.row, sample.column)) / (all + weight);
    all += weight;
  }
}

// Geman-McClure weights.
void MatrixNormalWindow::weigh_softly(const Matrix& energy) {
  const double place =
      method_->soft_steps > 1 ? static_cast<double>(step_) / (method_->soft_steps - 1) : 1;
  const double limit =
      method_->soft_first * std::pow(method_->soft_last / method_->soft_first, place);
  for (Index i = 0; i < frames_; ++i)
    for (Index j = 0; j < columns(); ++j) {
      weights_(i, j) = confirmed(i, j) ? observed_(i, j)
                                       : observed_(i, j) / square(1 + energy(i, j) / square(limit));
      solve_weights_(i, j) =
          weights_(i, j) / (square(sigma_) / confidence_(i, j) + predictive_(j) / 6);
    }
}

void MatrixNormalWindow::weigh_hard(const Matrix& energy, const ConstMatrixRef& motion) {
  Mask good = energy.array() < square(method_->hard);
  for (Index j = 0; j < columns(); ++j)
    for (Index i = 0; i < frames_; ++i) good(i, j) = good(i, j) || confirmed(i, j);
  weights_ = good.select(observed_, 0);
  solve_weights_.topRows(frames_) = weights_.cwiseProduct(confidence_) / square(sigma_);
  const bool exact = std::ranges::any_of(prior_->links, [](const auto& l) { return l.exact; });
  if (exact) build_on_lengths(motion);
}

// In gaps longer than a few frames, S put on the exact lengths is as good as a sample of the
// variance that the gap leaves open.
void MatrixNormalWindow::build_on_lengths(const ConstMatrixRef& motion) {
  const Index width = method_->joint_columns, joints = columns() / width;
  const Matrix h = gap_distance(weights_);
  const Mask lost = weights_.array() <= 0;
  Mask free(frames_, joints);
  for (Index j = 0; j < joints; ++j)
    free.col(j) = lost.middleCols(j * width, width).rowwise().any();
  const Mask open = observed_.array() <= 0 && h.array() > length_distance;
  for (Index i = 0; i < frames_; ++i)
    if (!open.row(i).any()) free.row(i).setConstant(false);  // a frame that asks for nothing
  Matrix placed = lost.select(motion.topRows(frames_), data_.topRows(frames_));
  const Mask moved = put_on_lengths(prior_->links, free, placed);
  target_ = data_;
  target_changed_ = true;
  for (Index i = 0; i < frames_; ++i)
    for (Index j = 0; j < columns(); ++j) {
      if (!open(i, j) || !moved(i, j / width)) continue;
      target_(i, j) = placed(i, j);
      solve_weights_(i, j) =
          length_weight / (square(sigma_) + open_variance(h(i, j)) * predictive_(j));
    }
}

// Magnitudes of the residuals that tell the noise, as samples of confidence 1 would have them.
std::vector<double> MatrixNormalWindow::residuals(const ConstMatrixRef& motion) const {
  const Eigen::VectorXd near = near_deviations * (square(sigma_) + predictive_.array() / 6).sqrt();
  const Matrix scale = confidence_.cwiseSqrt();
  std::vector<double> found(static_cast<std::size_t>(weights_.size()));
  std::size_t count = 0;
  for (Index i = 0; i < frames_; ++i)
    for (Index j = 0; j < columns(); ++j) {
      const double r = std::abs(data_(i, j) - motion(i, j)) * scale(i, j);
      const bool counts = hard() ? weights_(i, j) > 0 : observed_(i, j) > 0 && r < near(j);
      found[count] = r;  // written over by the next if it does not count: no branch
      count += counts;
    }
  found.resize(count);
  return found;
}

void MatrixNormalWindow::estimate_noise(const ConstMatrixRef& motion) {
  std::vector<double> residuals = this->residuals(motion);
  if (hard() && !residuals.empty()) {
    const double noise = square(sigma_) / share_kept(), least = least_spectrum();
    double kept = 0;
    for (const double e : spectrum_) kept += kept_power(noise, std::max(e, least));
    const double fitted = static_cast<double>(frames_) * weights_.mean() * kept / weights_.sum();
    const double free = std::sqrt(std::max(1 - fitted, 0.02));
    sigma_ = std::max({deviation_per_mad * median(residuals) / free, least_noise_, noise_floor_});
  } else if (2 * step_ >= method_->soft_steps && residuals.size() > 100) {
    sigma_ = std::max(
        {deviation_per_mad * median(residuals), least_noise_, soft_floor_share * noise_floor_});
  }
  ++step_;
}

Matrix MatrixNormalWindow::cleaned(const ConstMatrixRef& motion) const {
  Matrix result = motion.topRows(frames_);
  if (sigma_ <= noise_floor_) result = trusted().select(data_.topRows(frames_), result);
  leave_unobserved(result);
  return result;
}

void MatrixNormalWindow::leave_unobserved(Matrix& result) const {
  for (Index j = 0; j < columns(); ++j)
    if (observed_.col(j).sum() == 0) result.col(j).setConstant(missing);
}

// Column j of D, gaps where nothing is expected filled linearly.
std::vector<double> MatrixNormalWindow::filled(Index j) const {
  std::vector<double> channel(static_cast<std::size_t>(frames_));
  Eigen::Map<Eigen::VectorXd>(channel.data(), frames_) = data_.col(j).head(frames_);
  fill_linearly(channel, present_.col(j));
  return channel;
}

Matrix MatrixNormalWindow::all_filled() const {
  Matrix result(frames_, columns());
  for (Index j = 0; j < columns(); ++j) {
    const std::vector<double> channel = filled(j);
    result.col(j) = Eigen::Map<const Eigen::VectorXd>(channel.data(), frames_);
  }
  return result;
}

Matrix MatrixNormalWindow::filled() const {
  Matrix result = all_filled();
  leave_unobserved(result);
  return result;
}

Matrix MatrixNormalWindow::rejected(const ConstMatrixRef& cleaned) const {
  const Mask gross = observed_.array() > 0 && weights_.array() <= 0;
  return gross.select(data_.topRows(frames_) - cleaned, Matrix::Zero(frames_, columns()));
}

Mask MatrixNormalWindow::trusted() const { return weights_.array() > 0; }

Matrix MatrixNormalWindow::deviation(const ConstMatrixRef& motion,
                                     const ConstMatrixRef& eigenvectors) const {
  if (step_ == 0) return Matrix::Constant(frames_, columns(), missing);
  Matrix prior = Matrix::Constant(frames_, columns(), std::numeric_limits<double>::infinity());
  for (const PriorSample& sample : prior_samples_)
    prior(sample.row, sample.column) = sample.variance;
  Matrix result = marginal_deviation({.motion = motion.topRows(frames_),
                                      .used = trusted(),
                                      .rejected = rejected(motion.topRows(frames_)),
                                      .prior_variance = std::move(prior),
                                      .confidence = prior_->confidence,
                                      .eigenvectors = eigenvectors,
                                      .spectrum = spectrum_,
                                      .precision = precision_.head(frames_ - 2),
                                      .noise = sigma_,
                                      .size = noise_floor_ / noise_floor_share,
                                      .floor = noise_floor_,
                                      .joint_columns = method_->joint_columns,
                                      .has_prior = nearness_.size() > 0});
  leave_unobserved(result);
  return result;
}

}  // namespace moclean
