// Notation: D data, S motion, W weights, v variance of a sample, Q covariance of the accelerations
// with eigenvalues e, R about Q^-1, P precisions; see methods/matrix_normal/matrix_normal.hpp.
// Constants are those of methods/matrix_normal/window.cpp, written a second time.
#include "moclean/methods/matrix_normal/reference_model.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "moclean/core/order_statistics.hpp"
#include "moclean/methods/matrix_normal/prior.hpp"
#include "moclean/methods/matrix_normal/rounding_step.hpp"
#include "moclean/methods/matrix_normal/statistics.hpp"
#include "moclean/solve/missing.hpp"

namespace moclean::reference {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double unknown = std::numeric_limits<double>::infinity();
constexpr double tiny = std::numeric_limits<double>::min();
constexpr double in_use = 0.3;  // least weight of a sample that others are predicted from
constexpr double ends = 4;      // frames to what is in use beyond an end of the window

double robust_deviation(std::vector<double> magnitudes) { return 1.4826 * median(magnitudes); }

std::vector<double> magnitudes_of(const Eigen::VectorXd& x) {
  const Eigen::VectorXd magnitudes = x.cwiseAbs();
  return {magnitudes.begin(), magnitudes.end()};
}

// Frames of the gap around a missing sample.
Index gap_length(const Mask& observed, Index i, Index j) {
  Index first = i, last = i;
  while (first > 0 && !observed(first - 1, j)) --first;
  while (last + 1 < observed.rows() && !observed(last + 1, j)) ++last;
  return last - first + 1;
}

// What is known of missing samples.
void expect_positions(SmoothingState& s) {
  s.prior_variance = Matrix::Constant(s.frames(), s.columns(), unknown);
  s.prior_share = Matrix::Zero(s.frames(), s.columns());
  if (s.prior->positions.size() == 0) return;
  for (Index i = 0; i < s.frames(); ++i)
    for (Index j = 0; j < s.columns(); ++j) {
      const double variance = s.prior->variance(i, j / s.method->joint_columns);
      if (s.observed(i, j) || !std::isfinite(variance)) continue;
      const auto lags = static_cast<double>(gap_length(s.observed, i, j)) /
                        static_cast<double>(s.method->lag_frames);
      s.prior_variance(i, j) = variance;
      s.prior_share(i, j) = std::min(0.03 * lags, 0.3);
      s.data(i, j) = s.prior->positions(i, j);
    }
}

// [joints x joints] to [columns x columns]: columns are alike along the same axis only.
Matrix of_columns(const Matrix& nearness) {
  Matrix result = Matrix::Zero(3 * nearness.rows(), 3 * nearness.cols());
  for (Index i = 0; i < result.rows(); ++i)
    for (Index j = i % 3; j < result.cols(); j += 3) result(i, j) = nearness(i / 3, j / 3);
  return result;
}

double least_power(const SmoothingState& s) {
  return (s.hard() ? 1e-5 * s.spectrum.mean() : 1e-9 * s.spectrum.maxCoeff()) + tiny;
}

Eigen::VectorXd kept_under(const SmoothingState& s, double noise) {
  Eigen::VectorXd kept(s.columns());
  for (Index k = 0; k < s.columns(); ++k)
    kept(k) = kept_share(noise, std::max(s.spectrum(k), least_power(s)));
  return kept;
}

// Precisions by evidence, (f + g) / (f + a R a'); docs/decisions/heavy-tails.md.
Eigen::VectorXd precisions(const SmoothingState& s, const ConstMatrixRef& S, const Matrix& R) {
  if (!s.hard() || s.sigma <= 10 * s.floor) return Eigen::VectorXd::Ones(s.frames() - 2);
  const Matrix a = second_differences(S);
  const double noise = squared(s.sigma) / s.share_kept();
  const auto columns = static_cast<double>(s.columns());
  Eigen::VectorXd result(a.rows());
  for (Index k = 0; k < a.rows(); ++k) {
    double used = columns;
    for (Index i = k; i < k + 3; ++i)
      used = std::min(used, static_cast<double>((s.weights.row(i).array() > in_use).count()));
    double told = 0;
    for (const double e : s.spectrum) told += kept_share(noise, e / s.precision(k));
    const double f = 3 + 20 * (columns - used), energy = (a.row(k) * R * a.row(k).transpose())(0);
    result(k) = (f + used / columns * told) / (f + energy);
  }
  return result;
}

// Squared residuals over their predictive variance, at least the median of their joint's.
Matrix energies(const SmoothingState& s, const ConstMatrixRef& S) {
  const Matrix h = harmonic_distance(s.weights.array() > in_use, ends);
  const Matrix variance =
      squared(s.sigma) / s.confidence.array() + (h * s.predictive.asDiagonal()).array() / 6;
  Matrix energy = s.observed.select((s.data - S).cwiseAbs2().cwiseQuotient(variance), 0);
  for (Index i = 0; i < s.frames(); ++i)
    for (Index j = 0; j < s.columns(); j += s.method->joint_columns) {
      auto joint = energy.row(i).segment(j, std::min(s.method->joint_columns, s.columns() - j));
      std::vector<double> sorted(joint.begin(), joint.end());
      joint = joint.cwiseMax(median(sorted));
    }
  return energy;
}

// Geman-McClure weights of a threshold that falls geometrically, or rejection.
Matrix sample_weights(const SmoothingState& s, const Matrix& energy) {
  const MatrixNormal& m = *s.method;
  const double place = m.soft_steps > 1 ? static_cast<double>(s.step) / (m.soft_steps - 1) : 1;
  const double threshold = m.soft_first * std::pow(m.soft_last / m.soft_first, place);
  Matrix W = (1 + energy.array() / squared(threshold)).square().inverse();
  if (s.hard()) W = (energy.array() < squared(m.hard)).cast<double>();
  return s.observed.select(s.confirmed.select(1, W.array()), 0);
}

// Missing samples more than four frames from those in use, of joints that exact links hold, at
// their lengths.
void build_on_lengths(const SmoothingState& s, const ConstMatrixRef& S, Terms& terms) {
  const Index width = s.method->joint_columns, joints = s.columns() / width;
  const Matrix h = harmonic_distance(s.weights.array() > in_use, ends);
  const Mask lost = s.weights.array() <= 0, open = !s.observed && h.array() > 4;
  Mask free = Mask::Constant(s.frames(), joints, false), held = free;
  for (Index i = 0; i < s.frames(); ++i)
    for (Index j = 0; j < s.columns() && open.row(i).any(); ++j)
      if (lost(i, j)) free(i, j / width) = true;
  for (const DistanceLink& link : s.prior->links)
    if (link.exact) held.col(link.first) = held.col(link.second) = true;
  const Matrix placed = fitted_to_lengths(s.prior->links, free, lost.select(S, s.data));
  for (Index i = 0; i < s.frames(); ++i)
    for (Index j = 0; j < s.columns(); ++j)
      if (open(i, j) && held(i, j / width)) {
        const double gap = std::max(h(i, j) / 6, std::pow(h(i, j), 3) / 24);
        terms.weights(i, j) = 0.1 / (squared(s.sigma) + gap * s.predictive(j));
        terms.target(i, j) = placed(i, j);
      }
}

}  // namespace

SmoothingState begin(const ConstMatrixRef& data, const MatrixNormal& method,
                     const MotionPrior& prior) {
  SmoothingState s;
  s.method = &method;
  s.prior = &prior;
  s.data = observed_part(data);
  s.observed = !data.array().isNaN();
  s.weights = observed_entries(data);
  s.size = prior.size > 0 ? prior.size : column_scale(data);
  s.floor = 1.25e-5 * s.size;
  s.least_noise = std::max(rounding_deviation(data), prior.noise);
  s.sigma = std::max({dense_noise_level(data), s.least_noise, 0.1 * s.floor});
  s.precision = Eigen::VectorXd::Ones(std::max<Index>(s.frames() - 2, 0));
  s.confirmed = Mask::Constant(s.frames(), s.columns(), false);
  for (Index j = 0; j < s.columns() && prior.confirmed.size() > 0; ++j)
    s.confirmed.col(j) = prior.confirmed.col(j / method.joint_columns);
  s.confidence = Matrix::Ones(s.frames(), s.columns());
  if (prior.confidence.size() > 0) s.confidence = prior.confidence;
  expect_positions(s);
  if (method.joint_columns == 3 && s.columns() % 3 == 0 && s.observed.any())
    s.nearness = of_columns(nearness_of(filled(s)));
  return s;
}

Matrix filled(const SmoothingState& s) {
  const Mask known = s.observed || s.prior_variance.array().isFinite();
  return filled_along_time(known.select(s.data, nothing));
}

RoughMotion rough_motion(const SmoothingState& s) {
  RoughMotion rough{filled(s), Eigen::VectorXd(s.columns())};
  const Index h = std::min(s.method->lag_frames, (s.frames() - 1) / 2), n = s.frames() - 2 * h;
  for (Index j = 0; j < s.columns(); ++j) {
    const Eigen::VectorXd x = rough.motion.col(j);
    const Eigen::VectorXd lags = x.head(n) - 2 * x.segment(h, n) + x.tail(n);
    const double spread = robust_deviation(magnitudes_of(lags));
    const double power = std::max(squared(spread) - 6 * squared(s.sigma), 0.);
    rough.stiffness(j) = std::clamp(squared(s.sigma) / (power / std::pow(h, 4) + tiny), 1., 1000.);
    std::vector<double> medians(x.begin(), x.end());
    running_median(medians, s.method->median_frames);
    for (Index i = 0; i < s.frames(); ++i)
      rough.motion(i, j) = medians[static_cast<std::size_t>(i)];
  }
  return rough;
}

Matrix second_differences(const ConstMatrixRef& x) {
  Matrix a(std::max<Index>(x.rows() - 2, 0), x.cols());
  for (Index i = 0; i < a.rows(); ++i) a.row(i) = x.row(i) - 2 * x.row(i + 1) + x.row(i + 2);
  return a;
}

BandMatrix smoothing_system(const Eigen::VectorXd& weights, const Eigen::VectorXd& precision,
                            double stiffness) {
  constexpr std::array<double, 3> difference = {1, -2, 1};
  BandMatrix a{.width = 2, .rows = {}};
  for (const double w : weights) a.rows.push_back({w, 0, 0, 0});
  for (std::size_t k = 0; k + 2 < a.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j <= i; ++j)
        a.rows[k + i][i - j] +=
            stiffness * precision(static_cast<Index>(k)) * difference[i] * difference[j];
  return a;
}

double kept_share(double noise, double power) {
  return (1. / std::sqrt(std::complex(1., 4 * std::sqrt(noise / power)))).real();
}

std::optional<Eigen::VectorXd> kept_shares(const SmoothingState& s) {
  const double noise = squared(s.sigma);
  if (s.step == 0) return {};
  if (s.hard()) return kept_under(s, noise / s.share_kept());
  if (noise <= 10 * s.spectrum.mean() / 6) return {};
  return kept_under(s, noise);
}

Matrix learned_accelerations(const SmoothingState& s, const ConstMatrixRef& S) {
  Matrix a = second_differences(S.topRows(s.frames()));
  if (s.hard()) {
    const double mean_square = s.precision.cwiseSqrt().mean();
    for (Index k = 0; k < a.rows(); ++k)
      a.row(k) *= std::pow(s.precision(k), 0.25) / std::sqrt(mean_square);
    return a;
  }
  const auto clip = [](double x, double most) { return std::clamp(x, -most, most); };
  for (Index j = 0; j < a.cols(); ++j) {
    const double robust = robust_deviation(magnitudes_of(a.col(j)));
    double squares = 0;
    for (const double x : a.col(j)) squares += squared(clip(x, 6 * robust));
    const double spread = std::sqrt(squares / static_cast<double>(a.rows()));
    for (double& x : a.col(j)) x = clip(x, 5 * std::max(robust, spread / 2));
  }
  return a;
}

Matrix with_nearness_prior(const SmoothingState& s, const Matrix& Q) {
  if (s.nearness.size() == 0) return Q;
  const std::optional<Eigen::VectorXd> kept = kept_shares(s);
  const double left = kept ? kept->mean() : 1;
  const double seen = static_cast<double>(s.frames() - 2) * s.share_kept() * left;
  const double expected = 10 + 50 * (1 - left), share = expected / (expected + seen);
  const auto deviation = Q.diagonal().cwiseSqrt().asDiagonal();
  return (1 - share) * Q + share * (deviation * s.nearness * deviation);
}

Eigen::VectorXd ridged(const SmoothingState& s, const Eigen::VectorXd& eigenvalues) {
  const Eigen::ArrayXd e = eigenvalues.array().max(0) / static_cast<double>(s.frames() - 2);
  return e + (s.hard() ? 0.001 : 0.02) * e.mean() + squared(0.1 * s.floor);
}

Terms weigh(SmoothingState& s, const ConstMatrixRef& motion, const Matrix& R) {
  const ConstMatrixRef S = motion.topRows(s.frames());
  s.predictive = R.diagonal().cwiseInverse();
  s.precision = precisions(s, S, R);
  s.weights = sample_weights(s, energies(s, S));
  Terms terms{s.weights, s.data};
  for (Index i = 0; i < s.frames(); ++i)
    for (Index j = 0; j < s.columns(); ++j)
      terms.weights(i, j) /= s.variance(i, j) + (s.hard() ? 0 : s.predictive(j) / 6);
  const auto exact = [](const DistanceLink& link) { return link.exact; };
  if (s.hard() && std::ranges::any_of(s.prior->links, exact)) build_on_lengths(s, S, terms);
  for (Index i = 0; i < s.frames(); ++i)
    for (Index j = 0; j < s.columns(); ++j) {
      if (s.prior_share(i, j) == 0) continue;
      const double own = s.prior_share(i, j) / (squared(s.sigma) + s.prior_variance(i, j));
      const double other = terms.weights(i, j);
      terms.target(i, j) = (other * terms.target(i, j) + own * s.data(i, j)) / (other + own);
      terms.weights(i, j) = other + own;
    }
  return terms;
}

void estimate_noise(SmoothingState& s, const ConstMatrixRef& S) {
  std::vector<double> residuals;
  for (Index i = 0; i < s.frames(); ++i)
    for (Index j = 0; j < s.columns(); ++j) {
      const double r = std::abs(s.data(i, j) - S(i, j)) * std::sqrt(s.confidence(i, j));
      const double near = 3 * std::sqrt(squared(s.sigma) + s.predictive(j) / 6);
      if (s.hard() ? s.weights(i, j) > 0 : s.observed(i, j) && r < near) residuals.push_back(r);
    }
  if (s.hard() && !residuals.empty()) {
    // Of a sample, S has fitted as much as smoothing keeps of the mean column.
    const double fitted = kept_under(s, squared(s.sigma) / s.share_kept()).mean();
    const double left = std::sqrt(std::max(1 - fitted, 0.02));
    s.sigma = std::max({robust_deviation(residuals) / left, s.least_noise, s.floor});
  } else if (!s.hard() && 2 * s.step >= s.method->soft_steps && residuals.size() > 100) {
    s.sigma = std::max({robust_deviation(residuals), s.least_noise, 0.1 * s.floor});
  }
  ++s.step;
}

Matrix cleaned(const SmoothingState& s, const ConstMatrixRef& S) {
  Matrix result = S.topRows(s.frames());
  if (s.sigma <= s.floor) result = (s.weights.array() > 0).select(s.data, result);
  leave_unobserved(s, result);
  return result;
}

Matrix rejected(const SmoothingState& s, const ConstMatrixRef& x) {
  return (s.observed && s.weights.array() <= 0).select(s.data - x, 0);
}

void leave_unobserved(const SmoothingState& s, Matrix& x) {
  for (Index j = 0; j < s.columns(); ++j)
    if (!s.observed.col(j).any()) x.col(j).setConstant(nothing);
}

Matrix harmonic_distance(const Mask& used, double beyond_end) {
  Matrix h(used.rows(), used.cols());
  for (Index i = 0; i < used.rows(); ++i)
    for (Index j = 0; j < used.cols(); ++j) {
      Index before = i - 1, after = i + 1;
      while (before >= 0 && !used(before, j)) --before;
      while (after < used.rows() && !used(after, j)) ++after;
      const double a = static_cast<double>(i - before) + (before < 0 ? beyond_end - 1 : 0);
      const double b = static_cast<double>(after - i) + (after == used.rows() ? beyond_end - 1 : 0);
      h(i, j) = 2 * a * b / (a + b);
    }
  return h;
}

Matrix fitted_to_lengths(const std::vector<DistanceLink>& links, const Mask& free,
                         Matrix positions) {
  for (Index i = 0; i < free.rows(); ++i)
    for (int sweep = 0; sweep < 5; ++sweep)
      for (const DistanceLink& link : links) {
        const double first = free(i, link.first), second = free(i, link.second);
        if (!link.exact || first + second == 0) continue;
        auto a = positions.row(i).segment<3>(3 * link.first);
        auto b = positions.row(i).segment<3>(3 * link.second);
        const Eigen::RowVector3d apart = b - a;
        const double length = std::max(apart.norm(), tiny);
        const Eigen::RowVector3d excess = (length - link.length) / length * apart;
        a += first / (first + second) * excess;
        b -= second / (first + second) * excess;
      }
  return positions;
}

}  // namespace moclean::reference
