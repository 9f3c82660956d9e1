// Notation: S motion, Q covariance of its accelerations, R = Q^-1, Z eigenvectors of Q in rows, h
// harmonic distance of a sample to those in use before and after it, in frames.
#include "moclean/methods/matrix_normal/deviation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>

#include "moclean/core/band_matrix.hpp"
#include "moclean/core/order_statistics.hpp"
#include "moclean/methods/matrix_normal/window.hpp"

namespace moclean {
namespace {

constexpr double least_learned = 1.15, most_learned = 1.5, frames_learned = 5;  // learned_noise()
constexpr double alone_variance = 1.2 * 1.2;  // of gaps that others do not share, over the trials'
// Of the joined variance of a model and a prior that know the same samples: at least this share of
// the prior's, but no more than so many of the model's, which has left gross errors out.
constexpr double least_joined = 0.25, most_joined = 9;
constexpr double open_floor = 1.5 * 1.5;  // of samples not in use: solves end before they converge
constexpr std::array<Index, 7> lengths = {1, 3, 7, 15, 31, 63, 127};  // of gaps tried; h = 2^index
constexpr std::size_t fewest_trials = 16;
constexpr double one_deviation = 0.683, two_deviations = 0.954;  // shares of a normal distribution
constexpr double most_growth = 1.5;  // over that of a single frame, where columns fail together
constexpr double least_gross_error = 0.05;  // a typical one, share of the size

using Row = Eigen::Array<double, 1, Eigen::Dynamic>;
using ColumnMask = Eigen::Array<bool, Eigen::Dynamic, 1>;

Index width_of(const MotionEstimate& e, Index first) {
  return std::min(e.joint_columns, e.motion.cols() - first);
}

// Variance at the middle of a gap of independent accelerations of variance 1, exact for h = 1;
// h^3 / 24 of a random walk of velocities in long gaps.
double gap_variance(double h) { return h * (h + 1) * (h + 1) / 24; }

// Frames by which noise blurs the ends of a gap of such accelerations.
double blur(double noise, double power) {
  return std::max(std::sqrt(std::sqrt(noise / power)) - 0.5, 0.);
}

// h; twice the distance to the only side that has a sample in use.
Matrix harmonic_distance(const Mask& used) {
  const Index frames = used.rows();
  const auto none = static_cast<double>(4 * frames);
  Matrix h(frames, used.cols());
  Row away = Row::Constant(used.cols(), none);
  const auto next = [&](Index i) { away = used.row(i).select(1, away + 1); };
  for (Index i = 0; i < frames; ++i) {
    h.row(i) = away;
    next(i);
  }
  away.setConstant(none);
  for (Index i = frames - 1; i >= 0; --i) {
    auto row = h.row(i).array();
    row = 2 * row * away / (row + away);
    next(i);
  }
  return h;
}

// Of Student's t of three degrees of freedom at the square of a deviation.
double tail_density(double squared) { return 0.3676 / ((1 + squared / 3) * (1 + squared / 3)); }

double in_use(const MotionEstimate& e) { return std::max(e.used.cast<double>().mean(), 1e-3); }

// Variance of the noise in a frame; 0: none to speak of.
double noise_of(const MotionEstimate& e) {
  return e.noise <= e.floor ? 0 : e.noise * e.noise / in_use(e);
}

// Q has been learned from the same noise, and fits it: the variance of S over the model's, the more
// the fewer free accelerations are left of a column beside the number of columns; hardly where Q
// has a prior.
double learned_noise(const MotionEstimate& e) {
  if (e.has_prior) return least_learned;
  const double noise = noise_of(e);
  double kept = 0;
  for (const double power : e.spectrum) kept += kept_power(noise, power);
  const auto columns = static_cast<double>(e.spectrum.size());
  const double free = kept / columns * static_cast<double>(e.motion.rows()) * in_use(e);
  return least_learned * (1 + most_learned * columns / (columns + frames_learned * free));
}

// What white noise leaves uncertain of samples in use.
Matrix noise_variance(const MotionEstimate& e) {
  const double noise = noise_of(e);
  if (noise == 0) return Matrix::Zero(e.motion.rows(), e.motion.cols());
  const Eigen::VectorXd ratios = noise * e.spectrum.cwiseInverse();
  const Matrix shares = e.eigenvectors.cwiseAbs2();
  if (e.confidence.size() == 0) {
    const Matrix along = variance_left(ratios, e.precision, Eigen::VectorXd::Ones(e.motion.rows()));
    return learned_noise(e) * noise * along * shares;
  }
  Matrix variance(e.motion.rows(), e.motion.cols());
  Matrix along;
  for (Index j = 0; j < variance.cols(); ++j) {
    if (j == 0 || e.confidence.col(j) != e.confidence.col(j - 1))
      along = variance_left(ratios, e.precision, e.confidence.col(j));
    variance.col(j) = learned_noise(e) * noise * along * shares.col(j);
  }
  return variance;
}

// Q and R of the last step.
struct Covariance {
  explicit Covariance(const MotionEstimate& e)
      : Q(e.eigenvectors.transpose() * e.spectrum.asDiagonal() * e.eigenvectors),
        R(e.eigenvectors.transpose() * e.spectrum.cwiseInverse().asDiagonal() * e.eigenvectors) {}

  Matrix Q, R;
};

// Accelerations less what those of the other joints predict, and their variance under Q.
struct Innovations {
  Matrix values;             // [frames - 2 x columns]
  Eigen::VectorXd variance;  // [columns]
  Mask valid;                // [frames - 2 x columns]: of samples in use only
};

Innovations innovations_of(const MotionEstimate& e, const Matrix& R) {
  const Index count = e.motion.rows() - 2, columns = e.motion.cols();
  const Matrix a =
      e.motion.topRows(count) - 2 * e.motion.middleRows(1, count) + e.motion.bottomRows(count);
  const Matrix product = a * R;
  Innovations result;
  result.values.resize(count, columns);
  result.variance.resize(columns);
  result.valid.resize(count, columns);
  for (Index j = 0; j < columns; j += e.joint_columns) {
    const Index width = width_of(e, j);
    const Eigen::MatrixXd inverse =
        R.block(j, j, width, width).llt().solve(Eigen::MatrixXd::Identity(width, width));
    result.values.middleCols(j, width) = product.middleCols(j, width) * inverse;
    result.variance.segment(j, width) = inverse.diagonal();
    const ColumnMask joint = e.used.middleCols(j, width).rowwise().all();
    const ColumnMask three = joint.head(count) && joint.segment(1, count) && joint.tail(count);
    for (Index c = 0; c < width; ++c) result.valid.col(j + c) = three;
  }
  return result;
}

// Weights of length + 2 innovations in the error at the middle of a gap that they span.
std::vector<double> gap_weights(Index length) {
  const auto size = static_cast<std::size_t>(length);
  BandMatrix penalty{.width = 2, .rows = {}};
  for (std::size_t i = 0; i < size; ++i)
    penalty.rows.push_back({6., i >= 1 ? -4. : 0., i >= 2 ? 1. : 0., 0.});
  std::vector<double> x(size, 0);
  x[size / 2] = 1;
  factor(penalty);
  solve(penalty, x);
  std::vector<double> weights(size + 2, 0);
  for (std::size_t i = 0; i < size; ++i) {
    weights[i] += x[i];
    weights[i + 1] -= 2 * x[i];
    weights[i + 2] += x[i];
  }
  return weights;
}

// Deviation of magnitudes that is right for one and for two deviations as nearly as it gets.
double deviation_of(std::vector<double>& magnitudes) {
  return (quantile(magnitudes, one_deviation) + quantile(magnitudes, two_deviations) / 2) / 2;
}

// Variance of the errors of gaps of a length, over that of independent innovations; 0 for columns
// in which hardly any could be tried.
Row tried_growth(const Innovations& innovations, Index length) {
  const Index count = innovations.values.rows(), columns = innovations.values.cols();
  const std::vector<double> weights = gap_weights(length);
  const auto span = static_cast<Index>(weights.size()), stride = (length + 1) / 2;
  double squares = 0;
  for (const double w : weights) squares += w * w;
  std::vector<std::vector<double>> errors(static_cast<std::size_t>(columns));
  Row error(columns);
  for (Index first = 0; first + span <= count; first += stride) {
    error.setZero();
    for (Index a = 0; a < span; ++a)
      error += weights[static_cast<std::size_t>(a)] * innovations.values.row(first + a).array();
    const auto valid = innovations.valid.middleRows(first, span).colwise().all().eval();
    for (Index j = 0; j < columns; ++j)
      if (valid(j)) errors[static_cast<std::size_t>(j)].push_back(std::abs(error(j)));
  }
  Row growth = Row::Zero(columns);
  for (Index j = 0; j < columns; ++j) {
    std::vector<double>& own = errors[static_cast<std::size_t>(j)];
    if (own.size() < fewest_trials) continue;
    const double deviation = deviation_of(own);
    growth(j) = deviation * deviation / (squares * innovations.variance(j));
  }
  return growth;
}

// [lengths x columns]; columns without trials of a length have the others' (geometric) mean, a
// length without any has that of the length before.
Matrix growth_of(const Innovations& innovations) {
  Matrix growth(static_cast<Index>(lengths.size()), innovations.values.cols());
  for (std::size_t l = 0; l < lengths.size(); ++l) {
    const auto at = static_cast<Index>(l);
    const Row own = tried_growth(innovations, lengths[l]);
    const auto tried = own > 0;
    const auto known = static_cast<double>(tried.count());
    if (known == 0) {
      growth.row(at).setOnes();
      if (at > 0) growth.row(at) = growth.row(at - 1);
      continue;
    }
    const double mean = std::exp(tried.select(own, 1).log().sum() / known);
    growth.row(at) = tried.select(own, mean);
  }
  return growth;
}

// The growth of a column at h, between the lengths tried.
double growth_at(const Matrix& growth, Index column, double h) {
  const auto last = static_cast<double>(lengths.size() - 1);
  const double place = std::clamp(std::log2(h), 0., last);
  const auto low = std::min(static_cast<Index>(place), static_cast<Index>(lengths.size()) - 2);
  const double share = place - static_cast<double>(low);
  return (1 - share) * growth(low, column) + share * growth(low + 1, column);
}

// Innovations are those of the take that Q was learned from: over the variance in other frames.
double learned_from_itself(const MotionEstimate& e) {
  const double least = e.spectrum.minCoeff();
  const double fitted = (1 - least / e.spectrum.array()).sum();
  const double share = std::min(fitted / static_cast<double>(e.motion.rows() - 2), 0.7);
  return 1 / ((1 - share) * (1 - share));
}

// Of samples not in use: how much the variance of the innovation is larger because other joints are
// not in use in that frame.
Matrix excess_of(const MotionEstimate& e, const Covariance& model, const Eigen::VectorXd& own) {
  Matrix excess = Matrix::Zero(e.used.rows(), e.used.cols());
  for (Index i = 0; i < e.used.rows(); ++i) {
    if (e.used.row(i).all()) continue;
    if (i > 0 && (e.used.row(i) == e.used.row(i - 1)).all())
      excess.row(i) = excess.row(i - 1);
    else
      excess.row(i) =
          (conditional_variance(model.Q, model.R, e.used.row(i).transpose()) - own).cwiseMax(0);
  }
  return e.used.select(0, excess);
}

// Adds what gaps leave open to the variance of samples not in use. In a gap that others share in
// most of its frames their excess grows with it; where they are lost in single frames, it does not.
void add_open_variance(const MotionEstimate& e, Matrix& variance) {
  const Covariance model(e);
  const Innovations innovations = innovations_of(e, model.R);
  const Matrix h = harmonic_distance(e.used);
  Matrix growth = growth_of(innovations);
  const double noise = noise_of(e);
  if (noise > 0)  // smoothing took power from the innovations
    growth.rowwise() += innovations.variance.transpose().unaryExpr(
        [&](double power) { return 1 - kept_power(noise, power); });
  const Matrix excess = excess_of(e, model, innovations.variance);
  const double together = learned_from_itself(e), alone = alone_variance * together;
  std::vector<double> run;
  for (Index j = 0; j < e.used.cols(); ++j)
    for (Index first = 0, last = 0; first < e.used.rows(); first = last + 1) {
      for (last = first; last < e.used.rows() && !e.used(last, j);) ++last;
      if (last == first) continue;
      const auto excesses = excess.col(j).segment(first, last - first);
      run.assign(excesses.begin(), excesses.end());
      const double lasting = median(run), own = innovations.variance(j), ends = blur(noise, own);
      for (Index i = first; i < last; ++i) {
        const double grown = growth_at(growth, j, h(i, j));
        const double lasting_growth = std::min(grown / growth(0, j), most_growth);
        const double gap = gap_variance(h(i, j) + ends) - gap_variance(ends);
        variance(i, j) += alone * gap * own * grown +
                          together * (gap * lasting * lasting_growth +
                                      gap_variance(1) * std::max(excess(i, j) - lasting, 0.));
      }
    }
}

// A rejected sample may have been right: the odds are those of a heavy tail of the model's errors
// against gross errors, as frequent as rejected samples are, which are anywhere within a range.
void add_doubt(const MotionEstimate& e, Matrix& variance) {
  const double gross = (e.rejected.array() != 0).cast<double>().mean();
  if (gross == 0) return;
  const double squares =
      e.rejected.squaredNorm() / (gross * static_cast<double>(e.rejected.size()));
  const double range = std::max(std::sqrt(squares), least_gross_error * e.size);
  for (Index i = 0; i < variance.rows(); ++i)
    for (Index j = 0; j < variance.cols(); ++j) {
      const double off = e.rejected(i, j) * e.rejected(i, j);
      if (off == 0) continue;
      const double spread = variance(i, j) + e.noise * e.noise;
      const double right = tail_density(off / spread) / std::sqrt(spread);
      variance(i, j) += off * right / (right + gross / (2 * range));
    }
}

}  // namespace

Matrix variance_left(const Eigen::VectorXd& ratios, const Eigen::VectorXd& precision,
                     const Eigen::VectorXd& confidence) {
  const Index frames = precision.size() + 2, columns = ratios.size();
  const Row ratio = ratios.transpose();
  const auto at = [&](Index k) { return k >= 0 && k < precision.size() ? precision(k) : 0.; };
  // L diag(pivot) L', L with the lower bands `first` and `second`, from the first row on.
  Matrix inverse_pivot(frames, columns), first = Matrix::Zero(frames + 1, columns);
  Matrix second = Matrix::Zero(frames + 2, columns);
  for (Index i = 0; i < frames; ++i) {
    Row pivot = confidence(i) + ratio * (at(i) + 4 * at(i - 1) + at(i - 2));
    Row next = -2 * (at(i - 1) + at(i - 2)) * ratio;
    if (i >= 2) {
      second.row(i) = at(i - 2) * ratio * inverse_pivot.row(i - 2).array();
      pivot -= at(i - 2) * ratio * second.row(i).array();
      next -= at(i - 2) * ratio * first.row(i - 1).array();
    }
    if (i >= 1) first.row(i) = next * inverse_pivot.row(i - 1).array();
    inverse_pivot.row(i) = (pivot - next * first.row(i).array()).inverse();
  }
  // The bands of the inverse, from its last row on (Takahashi 1973).
  Matrix left(frames, columns);
  Row own = Row::Zero(columns), beside = own, far = own;  // (i, i), (i, i + 1), (i + 1, i + 1)
  for (Index i = frames - 1; i >= 0; --i) {
    const auto l1 = first.row(i + 1).array(), l2 = second.row(i + 2).array();
    const Row one = -l1 * own - l2 * beside, two = -l1 * beside - l2 * far;
    far = own;
    own = inverse_pivot.row(i).array() - l1 * one - l2 * two;
    beside = one;
    left.row(i) = own;
  }
  return left;
}

Eigen::VectorXd conditional_variance(const Matrix& Q, const Matrix& R, const ColumnMask& used) {
  std::vector<Index> known, unknown;
  for (Index j = 0; j < used.size(); ++j) (used(j) ? known : unknown).push_back(j);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(used.size());
  const auto count = static_cast<Index>(unknown.size());
  if (known.empty()) return Q.diagonal();
  if (unknown.size() <= known.size()) {
    const Eigen::LLT<Eigen::MatrixXd> factor(R(unknown, unknown));
    const Eigen::MatrixXd x = factor.matrixL().solve(Eigen::MatrixXd::Identity(count, count));
    variance(unknown) = x.colwise().squaredNorm();
  } else {
    const Eigen::LLT<Eigen::MatrixXd> factor(Q(known, known));
    const Eigen::MatrixXd x = factor.matrixL().solve(Eigen::MatrixXd(Q(known, unknown)));
    variance(unknown) = Q.diagonal()(unknown) - x.colwise().squaredNorm().transpose();
  }
  return variance;
}

Matrix marginal_deviation(const MotionEstimate& estimate) {
  Matrix variance = noise_variance(estimate);
  if (!estimate.used.all()) add_open_variance(estimate, variance);
  const auto prior = estimate.prior_variance.array();
  const auto joined = variance.array() * prior / (variance.array() + prior);
  const auto least = (least_joined * prior).min(most_joined * variance.array());
  variance = prior.isFinite().select(joined.max(least), variance.array());
  add_doubt(estimate, variance);
  const auto floors = estimate.used.cast<double>() * (1 - open_floor) + open_floor;
  return (variance.array() + floors * estimate.floor * estimate.floor).sqrt();
}

}  // namespace moclean
