// Notation: S motion, Q covariance of its accelerations, e its eigenvalues, R = Q^-1, Z
// eigenvectors of Q in rows, h harmonic distance of a sample to those in use before and after it.
// Constants are those of methods/matrix_normal/deviation.cpp, written a second time.
#include "moclean/methods/matrix_normal/reference_sigma.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>

#include "moclean/core/order_statistics.hpp"

namespace moclean::reference {
namespace {

constexpr std::array<Index, 7> tried_lengths = {1, 3, 7, 15, 31, 63, 127};  // of gaps

// What is the same in all entries.
struct Findings {
  Findings(const SmoothingState& s, const ConstMatrixRef& S, const Matrix& Z)
      : used(s.weights.array() > 0),
        share_used(std::max(used.cast<double>().mean(), 1e-3)),
        noise(s.sigma <= s.floor ? 0 : s.sigma * s.sigma / share_used),
        Q(Z.transpose() * s.spectrum.asDiagonal() * Z),
        R(Z.transpose() * s.spectrum.cwiseInverse().asDiagonal() * Z),
        innovations(joint_innovations(second_differences(S), Q, s.method->joint_columns)) {}

  Mask used;
  double share_used, noise;
  Matrix Q, R;
  JointInnovations innovations;
};

// Q fits the noise that it was learned from: by how much the variance of S is larger.
double learned_from_noise(const SmoothingState& s, const Findings& f) {
  if (s.nearness.size() > 0) return 1.15;
  double kept = 0;
  for (const double e : s.spectrum) kept += kept_share(f.noise, e);
  const auto columns = static_cast<double>(s.columns());
  const double free = kept / columns * static_cast<double>(s.frames()) * f.share_used;
  return 1.15 * (1 + 1.5 * columns / (columns + 5 * free));
}

Matrix variance_by_noise(const SmoothingState& s, const Findings& f, const Matrix& Z) {
  Matrix variance = Matrix::Zero(s.frames(), s.columns());
  if (f.noise == 0) return variance;
  if ((s.confidence.array() == 1).all()) {
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(s.frames());
    for (Index k = 0; k < s.columns(); ++k)
      variance += noise_left(ones, s.precision, f.noise / s.spectrum(k)) * Z.row(k).cwiseAbs2();
  } else {
    for (Index j = 0; j < s.columns(); ++j)
      for (Index k = 0; k < s.columns(); ++k)
        variance.col(j) += noise_left(s.confidence.col(j), s.precision, f.noise / s.spectrum(k)) *
                           squared(Z(k, j));
  }
  return learned_from_noise(s, f) * f.noise * variance;
}

// Whether the joint of a column is in use in all frames of `count` innovations.
bool in_use_throughout(const SmoothingState& s, const Mask& used, Index first, Index count,
                       Index column) {
  const Index width = s.method->joint_columns, joint = column / width * width;
  return used.block(first, joint, count + 2, std::min(width, s.columns() - joint)).all();
}

// Variance of the errors of gaps tried all over a column, over what it is if innovations are
// independent; 0 if hardly any gap could be tried.
double tried_growth(const SmoothingState& s, const Findings& f, Index column,
                    const Eigen::VectorXd& shares) {
  const Eigen::VectorXd a = f.innovations.values.col(column);
  const Index span = shares.size(), length = span - 2;
  std::vector<double> errors;
  for (Index first = 0; first + span <= a.size(); first += (length + 1) / 2)
    if (in_use_throughout(s, f.used, first, span, column))
      errors.push_back(std::abs(shares.dot(a.segment(first, span))));
  if (errors.size() < 16) return 0;
  const double deviation = (quantile(errors, 0.683) + quantile(errors, 0.954) / 2) / 2;
  return squared(deviation) / (shares.squaredNorm() * f.innovations.variance(column));
}

// [lengths x columns]. What could not be tried is the geometric mean of the columns that could, or
// as the length before.
Matrix growth_by_length(const SmoothingState& s, const Findings& f) {
  Matrix growth = Matrix::Ones(std::ssize(tried_lengths), s.columns());
  for (Index l = 0; l < growth.rows(); ++l) {
    const Eigen::VectorXd shares = shares_in_gap(tried_lengths[static_cast<std::size_t>(l)]);
    double logarithms = 0, tried = 0;
    for (Index j = 0; j < s.columns(); ++j) {
      growth(l, j) = tried_growth(s, f, j, shares);
      if (!(growth(l, j) > 0)) continue;
      logarithms += std::log(growth(l, j));
      ++tried;
    }
    for (Index j = 0; j < s.columns(); ++j) {
      const double other = tried > 0 ? std::exp(logarithms / tried) : l > 0 ? growth(l - 1, j) : 1;
      if (!(growth(l, j) > 0)) growth(l, j) = other;
    }
  }
  return growth;
}

// At h, 2^l for the length l, linear in between in the logarithm.
double growth_at(const Eigen::VectorXd& by_length, double h) {
  const double place = std::clamp(std::log2(h), 0., static_cast<double>(by_length.size() - 1));
  const Index low = std::min(static_cast<Index>(place), by_length.size() - 2);
  const double part = place - static_cast<double>(low);
  return by_length(low) + part * (by_length(low + 1) - by_length(low));
}

// By how much the variance of an innovation is larger where other joints are not in use, either.
Matrix excess_variance(const SmoothingState& s, const Findings& f) {
  Matrix excess = Matrix::Zero(s.frames(), s.columns());
  for (Index i = 0; i < s.frames(); ++i) {
    const Eigen::VectorXd given = variance_given(f.used.row(i), f.R);
    for (Index j = 0; j < s.columns(); ++j)
      if (!f.used(i, j)) excess(i, j) = std::max(given(j) - f.innovations.variance(j), 0.);
  }
  return excess;
}

// Of the take that Q was learned from, the variance of the innovations is smaller than of others.
double learned_from_take(const SmoothingState& s) {
  double fitted = 0;
  for (const double e : s.spectrum) fitted += 1 - s.spectrum.minCoeff() / e;
  const double share = std::min(fitted / static_cast<double>(s.frames() - 2), 0.7);
  return 1 / squared(1 - share);
}

// At the middle of a gap of independent accelerations of variance 1.
double gap_variance(double h) { return h * squared(h + 1) / 24; }

// Adds what gaps leave open to the variance of samples not in use.
void add_open(const SmoothingState& s, const Findings& f, Matrix& variance) {
  Matrix growth = growth_by_length(s, f);
  const Matrix h = harmonic_distance(f.used, static_cast<double>(4 * s.frames()));
  const Matrix excess = excess_variance(s, f);
  const double together = learned_from_take(s), alone = squared(1.2) * together;
  for (Index j = 0; j < s.columns(); ++j) {
    const double own = f.innovations.variance(j);
    double blurred = 0;  // frames that noise blurs the ends of a gap by
    if (f.noise > 0) {
      growth.col(j).array() += 1 - kept_share(f.noise, own);
      blurred = std::max(std::pow(f.noise / own, 0.25) - 0.5, 0.);
    }
    for (Index i = 0; i < s.frames(); ++i) {
      if (f.used(i, j)) continue;
      Index first = i, last = i + 1;  // of the gap
      while (first > 0 && !f.used(first - 1, j)) --first;
      while (last < s.frames() && !f.used(last, j)) ++last;
      const Eigen::VectorXd shared = excess.col(j).segment(first, last - first);
      std::vector<double> sorted(shared.begin(), shared.end());
      const double lasting = median(sorted), passing = std::max(excess(i, j) - lasting, 0.);
      const double gap = gap_variance(h(i, j) + blurred) - gap_variance(blurred);
      const double grown = growth_at(growth.col(j), h(i, j));
      variance(i, j) += alone * gap * own * grown +
                        together * (gap * lasting * std::min(grown / growth(0, j), 1.5) +
                                    gap_variance(1) * passing);
    }
  }
}

// By precision, but both know the same samples.
double joined(double own, double prior) {
  if (!std::isfinite(prior)) return own;
  return std::max(own * prior / (own + prior), std::min(prior / 4, 9 * own));
}

// Of Student's t of three degrees of freedom at the square of a deviation.
double heavy_tail(double square) { return 0.3676 / squared(1 + square / 3); }

// A rejected sample may have been right: a heavy tail of the model's errors against gross errors,
// as frequent as rejected samples are, anywhere in a range.
void add_doubt(const SmoothingState& s, const Matrix& rejected, Matrix& variance) {
  const auto count = static_cast<double>((rejected.array() != 0).count());
  if (count == 0) return;
  const double gross = count / static_cast<double>(rejected.size());
  const double range = std::max(rejected.norm() / std::sqrt(count), 0.05 * s.size);
  for (Index i = 0; i < s.frames(); ++i)
    for (Index j = 0; j < s.columns(); ++j) {
      if (rejected(i, j) == 0) continue;
      const double off = squared(rejected(i, j)), spread = variance(i, j) + squared(s.sigma);
      const double right = heavy_tail(off / spread) / std::sqrt(spread);
      variance(i, j) += right / (right + gross / (2 * range)) * off;
    }
}

}  // namespace

Eigen::VectorXd noise_left(const Eigen::VectorXd& confidence, const Eigen::VectorXd& precision,
                           double ratio) {
  BandMatrix system = smoothing_system(confidence, precision, ratio);
  factor(system);
  const BandMatrix inverse = inverse_in_band(system);
  Eigen::VectorXd diagonal(precision.size() + 2);
  for (std::size_t i = 0; i < inverse.size(); ++i)
    diagonal(static_cast<Index>(i)) = inverse.rows[i][0];
  return diagonal;
}

Eigen::VectorXd variance_given(const Mask& used, const Matrix& R) {
  std::vector<Index> open;
  for (Index j = 0; j < used.size(); ++j)
    if (!used(j)) open.push_back(j);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(used.size());
  if (open.empty()) return variance;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(std::ssize(open), std::ssize(open));
  variance(open) = Eigen::MatrixXd(R(open, open)).llt().solve(one).diagonal();
  return variance;
}

JointInnovations joint_innovations(const Matrix& accelerations, const Matrix& Q,
                                   Index joint_columns) {
  JointInnovations result{accelerations, Q.diagonal()};
  for (Index first = 0; first < Q.cols(); first += joint_columns) {
    std::vector<Index> joint, others;
    for (Index j = 0; j < Q.cols(); ++j)
      (j >= first && j < first + joint_columns ? joint : others).push_back(j);
    if (others.empty()) continue;
    const Eigen::MatrixXd predicts =
        Eigen::MatrixXd(Q(others, others)).llt().solve(Eigen::MatrixXd(Q(others, joint)));
    result.values(Eigen::all, joint) -= accelerations(Eigen::all, others) * predicts;
    result.variance(joint) -= (Q(joint, others) * predicts).diagonal();
  }
  return result;
}

Eigen::VectorXd shares_in_gap(Index length) {
  Eigen::MatrixXd delta = Eigen::MatrixXd::Zero(length + 2, length);
  for (Index i = 0; i < length; ++i) delta.col(i).segment<3>(i) << 1, -2, 1;
  const Eigen::MatrixXd square = delta.transpose() * delta;
  return delta * square.llt().solve(Eigen::VectorXd::Unit(length, length / 2));
}

Matrix deviation(const SmoothingState& s, const ConstMatrixRef& motion, const Matrix& Z) {
  if (s.step == 0) return Matrix::Constant(s.frames(), s.columns(), std::nan(""));
  const ConstMatrixRef S = motion.topRows(s.frames());
  const Findings f(s, S, Z);
  Matrix variance = variance_by_noise(s, f, Z);
  if (!f.used.all()) add_open(s, f, variance);
  variance = variance.binaryExpr(s.prior_variance, &joined).eval();
  add_doubt(s, rejected(s, S), variance);
  const double in_use = squared(s.floor), not_in_use = squared(1.5 * s.floor);
  variance += f.used.select(in_use, Matrix::Constant(s.frames(), s.columns(), not_in_use));
  Matrix result = variance.cwiseSqrt();
  leave_unobserved(s, result);
  return result;
}

}  // namespace moclean::reference
