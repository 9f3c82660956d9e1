#include "moclean/denoise/confidence_weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr double surest = 0.95;  // quantile of the confidences that counts as 1
constexpr double least_weight = 0.05;
constexpr std::array<double, 5> class_ends = {1. / 16, 1. / 8, 1. / 4, 1. / 2, 3. / 4};
constexpr std::array<double, 5> fourth_difference = {1, -4, 6, -4, 1};
constexpr std::size_t fewest = 8;  // of a class or a column that is looked at
// Of the logarithm of a median square, times the number it is of; twice that of independent ones.
constexpr double variance_of_median = 11;
constexpr double prior_deviation = 0.5;
constexpr int steps = 8;  // of the exponents tried

bool is_told(double confidence) { return std::isfinite(confidence); }

// Of the observed samples.
double confidence_that_is_one(const Recording& take) {
  std::vector<double> told;
  for (Index i = 0; i < take.confidence.rows(); ++i)
    for (Index j = 0; j < take.confidence.cols(); ++j)
      if (is_told(take.confidence(i, j)) && !std::isnan(take.samples(i, j)))
        told.push_back(take.confidence(i, j));
  return told.empty() ? 0 : quantile(told, surest);
}

// Confidences from `least_weight` to 1.
Matrix relative(const Matrix& confidence, double one) {
  return confidence.unaryExpr(
      [&](double c) { return is_told(c) ? std::clamp(c / one, least_weight, 1.) : 1.; });
}

std::size_t class_of(double confidence) {
  const auto* const end = std::ranges::upper_bound(class_ends, confidence);
  return static_cast<std::size_t>(end - class_ends.begin());
}

// Fourth differences of a column where all five samples are observed.
struct Differences {
  std::vector<Index> frames;  // of the sample in the middle
  std::vector<double> squares;
};

Differences differences_of(const Eigen::VectorXd& x) {
  Differences found;
  for (Index i = 2; i + 2 < x.size(); ++i) {
    double sum = 0;
    for (Index k = 0; k < 5; ++k)
      sum += fourth_difference[static_cast<std::size_t>(k)] * x(i + k - 2);
    if (std::isnan(sum)) continue;
    found.frames.push_back(i);
    found.squares.push_back(sum * sum);
  }
  return found;
}

// Of the fourth difference around a frame of noise of these variances.
double variance_around(Index frame, const Eigen::VectorXd& variances) {
  double sum = 0;
  for (Index k = 0; k < 5; ++k) {
    const double factor = fourth_difference[static_cast<std::size_t>(k)];
    sum += factor * factor * variances(frame + k - 2);
  }
  return sum;
}

// Minus the logarithm of the evidence for an exponent, but for a constant.
double misfit(const std::vector<Differences>& columns, const Matrix& confidence, double exponent) {
  std::array<std::vector<double>, class_ends.size() + 1> classes;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const Differences& own = columns[j];
    if (own.frames.size() < fewest) continue;
    const auto certainty = confidence.col(static_cast<Index>(j)).array();
    const Eigen::VectorXd variances = certainty.pow(-exponent);
    std::vector<double> ratios(own.squares);
    for (std::size_t k = 0; k < ratios.size(); ++k)
      ratios[k] /= variance_around(own.frames[k], variances);
    std::vector<double> sorted = ratios;
    const double unit = median(sorted);
    for (std::size_t k = 0; unit > 0 && k < ratios.size(); ++k)
      classes[class_of(certainty(own.frames[k]))].push_back(ratios[k] / unit);
  }
  double count = 0, sum = 0, squares = 0;
  for (std::vector<double>& values : classes) {
    if (values.size() < fewest) continue;
    const auto weight = static_cast<double>(values.size()) / variance_of_median;
    const double logarithm = std::log(std::max(median(values), 1e-12));
    count += weight;
    sum += weight * logarithm;
    squares += weight * logarithm * logarithm;
  }
  const double off = (1 - exponent) / prior_deviation;
  return (count > 0 ? squares - sum * sum / count : 0) + off * off;
}

double exponent_of(const Matrix& samples, const Matrix& confidence) {
  std::vector<Differences> columns;
  for (Index j = 0; j < samples.cols(); ++j) columns.push_back(differences_of(samples.col(j)));
  double best = 1, least = std::numeric_limits<double>::infinity();
  for (int k = steps; k >= 0; --k) {
    const double exponent = static_cast<double>(k) / steps;
    const double own = misfit(columns, confidence, exponent);
    if (own < least) {
      least = own;
      best = exponent;
    }
  }
  return best;
}

}  // namespace

double confidence_exponent(const Recording& take) {
  const double one = confidence_that_is_one(take);
  return one > 0 ? exponent_of(take.samples, relative(take.confidence, one)) : 1;
}

Matrix confidence_weights(const Recording& take) {
  const double one = confidence_that_is_one(take);
  if (!(one > 0)) return {};
  Matrix weights = relative(take.confidence, one);
  if ((weights.array() == 1).all()) return {};
  const double exponent = exponent_of(take.samples, weights);
  if (exponent == 0) return {};
  weights = weights.array().pow(exponent);
  return weights;
}

}  // namespace moclean
