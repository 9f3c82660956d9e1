#include "moclean/body/gap_trials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr std::array<double, 4> decays = {0.05, 0.2, 0.7, 20};
constexpr double chance_share = 0.1;  // of the usual disagreement
constexpr double near_edge = 0.2;     // depth up to which a single candidate is surer
constexpr double shrinkage = 0.05;    // of the errors' covariance to its diagonal

struct Prediction {
  Frames frames;  // the edges come first
  Candidates made;
};

Prediction predicted(const Gap& gap, const Frames& inner, const Predictor& predict) {
  Prediction found{edges(gap), {}};
  found.frames.insert(found.frames.end(), inner.begin(), inner.end());
  found.made = predict(gap, found.frames);
  return found;
}

// How much of the misses at the first edge a frame `away` from it and `beyond` from the other has.
double share_of_miss(double away, double beyond, double decay) {
  const double whole = away + beyond;
  // sinh(beyond / decay) / sinh(whole / decay), which is a line for a long decay
  return std::exp(-away / decay) * std::expm1(-2 * beyond / decay) / std::expm1(-2 * whole / decay);
}

Index edge_count(const Gap& gap) { return Index{gap.before} + Index{gap.after}; }

// The candidate's misses at the edges, [edges x 3].
Matrix misses(const BodyTake& take, const Gap& gap, const Prediction& prediction, std::size_t k) {
  Matrix found(edge_count(gap), 3);
  for (Index e = 0; e < found.rows(); ++e)
    found.row(e) = take.position(prediction.frames[static_cast<std::size_t>(e)], gap.joint) -
                   prediction.made[k].row(e);
  return found;
}

// The candidate without its edges, misses at these taken out.
Matrix bridged(const Gap& gap, const Prediction& prediction, std::size_t k, const Matrix& miss,
               double decay) {
  const Index edges = miss.rows(), count = prediction.made[k].rows() - edges;
  Matrix result = prediction.made[k].bottomRows(count);
  const double frames = decay * static_cast<double>(gap.frames() + 1);
  for (Index i = 0; i < count; ++i) {
    const Index frame = prediction.frames[static_cast<std::size_t>(i + edges)];
    const auto left = static_cast<double>(frame - gap.first + 1);
    const auto right = static_cast<double>(gap.last - frame);
    if (edges == 2) {
      result.row(i) += share_of_miss(left, right, frames) * miss.row(0) +
                       share_of_miss(right, left, frames) * miss.row(1);
    } else {
      result.row(i) += std::exp(-(gap.before ? left : right + 1) / frames) * miss.row(0);
    }
  }
  return result;
}

double depth(const Gap& gap, Index frame) {
  const double p = place(gap, frame);
  return gap.before && gap.after ? std::min(p, 1 - p) : p;
}

// Weights of least w'Cw that sum to 1, none below 0; 0 for what has no finite variance.
Eigen::VectorXd best_weights(Eigen::MatrixXd covariance) {
  const Eigen::Array<bool, Eigen::Dynamic, 1> known = covariance.diagonal().array().isFinite();
  for (Index k = 0; k < known.size(); ++k)
    if (!known(k)) {
      covariance.row(k).setZero();
      covariance.col(k).setZero();
    }
  covariance.diagonal().array() *= 1 + shrinkage;
  covariance.diagonal().array() += std::numeric_limits<double>::min();
  Eigen::VectorXd used = known.cast<double>();
  if (!known.any()) return used;
  while (true) {
    // Those not used have rows and columns of the unit matrix, and 0 on the right.
    Eigen::MatrixXd c = used.asDiagonal() * covariance * used.asDiagonal();
    const double scale = c.diagonal().maxCoeff();
    c.diagonal() += scale * (1 - used.array()).matrix();
    Eigen::VectorXd w = c.ldlt().solve(used);
    if (!w.allFinite() || w.sum() <= 0) w = used;
    Index worst = 0;
    if (w.minCoeff(&worst) >= 0) return w / w.sum();
    used(worst) = 0;
  }
}

struct Tried {
  std::vector<Frames> inner;
  std::vector<Prediction> predictions;
};

// Errors of a candidate at the probes of all trials, one coordinate below the other.
Eigen::VectorXd errors_of(const BodyTake& take, std::span<const Gap> trials, const Tried& tried,
                          std::size_t k, double decay) {
  std::vector<double> found;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Matrix miss = misses(take, trials[t], tried.predictions[t], k);
    const Matrix positions = bridged(trials[t], tried.predictions[t], k, miss, decay);
    for (std::size_t i = 0; i < tried.inner[t].size(); ++i) {
      const Eigen::RowVector3d off =
          positions.row(static_cast<Index>(i)) - take.position(tried.inner[t][i], trials[t].joint);
      found.insert(found.end(), off.begin(), off.end());
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(found.data(), static_cast<Index>(found.size()));
}

// The errors of all candidates, in columns, each with the best decay.
Eigen::MatrixXd learn_decays(const BodyTake& take, std::span<const Gap> trials, const Tried& tried,
                             FillRule& rule) {
  Eigen::MatrixXd errors;
  const std::size_t count = tried.predictions.front().made.size();
  for (std::size_t k = 0; k < count; ++k) {
    Eigen::VectorXd best;
    rule.shares.push_back({0, 0});
    for (const double decay : decays) {
      Eigen::VectorXd off = errors_of(take, trials, tried, k, decay);
      if (best.size() > 0 && !(off.squaredNorm() < best.squaredNorm())) continue;
      best = std::move(off);
      rule.shares[k].decay = decay;
    }
    errors.conservativeResize(best.size(), static_cast<Index>(count));
    errors.col(static_cast<Index>(k)) = best;
  }
  return errors;
}

// A fill without the edges of its gap, and how far its candidates disagree.
struct Combined {
  Matrix positions;
  Eigen::VectorXd disagreement;
  double missed = 0;  // mean square of a coordinate at the edges
};

Combined combined(const BodyTake& take, const Gap& gap, const Prediction& prediction,
                  const FillRule& rule) {
  const Index skipped = edge_count(gap);
  const Index count = static_cast<Index>(prediction.frames.size()) - skipped;
  Combined found{Matrix::Zero(count, 3), Eigen::VectorXd(count)};
  std::vector<Matrix> each;
  Matrix all_missed = Matrix::Zero(skipped, 3);
  for (std::size_t k = 0; k < rule.shares.size(); ++k) {
    const Matrix miss = misses(take, gap, prediction, k);
    each.push_back(bridged(gap, prediction, k, miss, rule.shares[k].decay));
    if (rule.shares[k].weight <= 0) continue;  // which may be none
    found.positions += rule.shares[k].weight * each.back();
    all_missed += rule.shares[k].weight * miss;
  }
  found.missed = all_missed.squaredNorm() / static_cast<double>(all_missed.size());
  std::vector<double> distances;
  for (Index i = 0; i < count; ++i) {
    distances.clear();
    for (const Matrix& one : each) {
      const double square = (one.row(i) - found.positions.row(i)).squaredNorm() / 3;
      if (std::isfinite(square)) distances.push_back(square);
    }
    const Index frame = prediction.frames[static_cast<std::size_t>(i + skipped)];
    found.disagreement(i) =
        distances.size() > 1 ? median(distances) : std::min(1., depth(gap, frame) / near_edge);
  }
  return found;
}

void learn_variance(const BodyTake& take, std::span<const Gap> trials, const Tried& tried,
                    FillRule& rule) {
  std::vector<double> squares, disagreements;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Combined made = combined(take, trials[t], tried.predictions[t], rule);
    rule.most_missed = std::max(rule.most_missed, made.missed);
    for (std::size_t i = 0; i < tried.inner[t].size(); ++i) {
      const auto row = static_cast<Index>(i);
      const Eigen::RowVector3d off =
          made.positions.row(row) - take.position(tried.inner[t][i], trials[t].joint);
      squares.push_back(off.squaredNorm() / 3);
      disagreements.push_back(made.disagreement(row));
    }
  }
  rule.least_disagreement =
      chance_share * median(disagreements) + std::numeric_limits<double>::min();
  for (std::size_t i = 0; i < squares.size(); ++i)
    rule.variance_share += squares[i] / (disagreements[i] + rule.least_disagreement);
  const auto count = static_cast<double>(trials.size());
  rule.variance_share *= (count + 2) / count / static_cast<double>(squares.size());
}

}  // namespace

FillRule learn_fill_rule(const BodyTake& take, std::span<const Gap> trials, Index probed,
                         const Predictor& predict) {
  FillRule rule;
  if (trials.empty()) return rule;
  Tried tried;
  for (const Gap& trial : trials) {
    tried.inner.push_back(probes(trial, probed));
    tried.predictions.push_back(predicted(trial, tried.inner.back(), predict));
  }
  const Eigen::MatrixXd errors = learn_decays(take, trials, tried, rule);
  const Eigen::VectorXd weights = best_weights(errors.transpose() * errors);
  for (std::size_t k = 0; k < rule.shares.size(); ++k)
    rule.shares[k].weight = weights(static_cast<Index>(k));
  if (weights.sum() <= 0) return {};
  learn_variance(take, trials, tried, rule);
  return rule;
}

Matrix fill(const BodyTake& take, const Gap& gap, const Predictor& predict, const FillRule& rule) {
  Frames inner;
  for (Index i = gap.first; i < gap.last; ++i) inner.push_back(i);
  const Combined made = combined(take, gap, predicted(gap, inner, predict), rule);
  Matrix result(gap.frames(), 4);
  result << made.positions,
      (rule.variance_share * (made.disagreement.array() + rule.least_disagreement) +
       std::max(0., made.missed - rule.most_missed))
          .matrix();
  return result;
}

}  // namespace moclean
