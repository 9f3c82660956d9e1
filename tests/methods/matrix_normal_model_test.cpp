// The statistics of the reference of matrix-normal smoothing, by hand.
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "moclean/methods/matrix_normal/reference_model.hpp"
#include "moclean/methods/matrix_normal/reference_sigma.hpp"
#include "moclean/methods/matrix_normal/statistics.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean::reference {
namespace {

using test::nan;

constexpr double infinite = std::numeric_limits<double>::infinity();

// A state in step `step` of the method {.joint_columns = 1}, of a body of size 1: its floor is
// 1.25e-5. All samples are in use; sigma is 0.5.
struct Example {
  explicit Example(const Matrix& data, int step = 0, MotionPrior known = {})
      : prior(std::move(known)) {
    prior.size = 1;
    state = begin(data, method, prior);
    state.sigma = 0.5;
    state.step = step;
    state.spectrum = Eigen::VectorXd::Ones(data.cols());
    state.predictive = state.spectrum;
  }

  MatrixNormal method = {.joint_columns = 1};
  MotionPrior prior;
  SmoothingState state;
};

// Of one column.
Matrix column(std::initializer_list<double> values) {
  Matrix result(static_cast<Index>(values.size()), 1);
  std::ranges::copy(values, result.data());
  return result;
}

Eigen::MatrixXd dense(const BandMatrix& a) {
  const auto n = static_cast<Index>(a.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index k = 0; k <= std::min<Index>(i, 2); ++k)
      result(i, i - k) = result(i - k, i) =
          a.rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
  return result;
}

TEST(ColumnScale, IsThreeRobustDeviationsOfTheMedianColumn) {
  Matrix data(5, 3);
  data << 0, 0, nan, 1, 5, 7, 2, 10, nan, 3, 15, 7, 10, 20, 7;  // spreads 1, 5, 0

  EXPECT_DOUBLE_EQ(column_scale(data), 3 * 1.4826);
  EXPECT_EQ(column_scale(Matrix::Constant(4, 2, -6)), 6);
  EXPECT_GT(column_scale(Matrix::Zero(4, 2)), 0);
}

TEST(DenseNoise, IsTheLowerQuartileOfFourthDifferences) {
  Matrix data(80, 1);
  for (Index i = 0; i < 80; ++i) data(i, 0) = i % 2 == 0 ? 0.5 : -0.5;  // they are 8 and -8

  EXPECT_DOUBLE_EQ(dense_noise_level(data), 8 / 0.3186 / std::sqrt(70.));
}

TEST(KeptShare, IsTheMeanOverFrequencies) {
  for (const double ratio : {1e-6, 0.01, 1., 50., 1e6}) {
    double mean = 0;
    constexpr int midpoints = 200000;
    for (int i = 0; i < midpoints; ++i) {
      const double w = (i + 0.5) / midpoints * std::numbers::pi;
      mean += 1 / (1 + ratio * std::pow(2 - 2 * std::cos(w), 2)) / midpoints;
    }
    EXPECT_NEAR(kept_share(3 * ratio, 3), mean, test::tolerance::two_texts()) << ratio;
  }
  EXPECT_EQ(kept_share(0, 3), 1);
}

TEST(HarmonicDistance, IsThatToSamplesInUse) {
  Mask used(5, 1);
  used << true, false, false, true, true;

  const Matrix h = harmonic_distance(used, 4);

  EXPECT_DOUBLE_EQ(h(0, 0), 2. * 4 * 3 / 7);  // four frames to what is beyond the end
  EXPECT_DOUBLE_EQ(h(1, 0), 2. * 1 * 2 / 3);
  EXPECT_DOUBLE_EQ(h(2, 0), 2. * 2 * 1 / 3);
  EXPECT_DOUBLE_EQ(h(4, 0), 2. * 1 * 4 / 5);
}

TEST(SmoothingSystem, IsThatOfAPaperCalculation) {
  const BandMatrix a = smoothing_system(Eigen::Vector4d(1, 0, 0, 2), Eigen::Vector2d(1, 3), 10);

  Eigen::MatrixXd expected(4, 4);
  expected << 11, -20, 10, 0, -20, 70, -80, 30, 10, -80, 130, -60, 0, 30, -60, 32;
  EXPECT_EQ(dense(a), expected);
  EXPECT_EQ(dense(smoothing_system(Eigen::Vector2d(1, 4), {}, 10)).trace(), 5);
}

TEST(FittedToLengths, MovesFreeEndsAlike) {
  Matrix positions(2, 6);
  positions << 0, 0, 0, 3, 0, 0, 0, 0, 0, 3, 0, 0;
  Mask free(2, 2);
  free << true, true, false, true;

  const Matrix fitted = fitted_to_lengths({{0, 1, 2, true, true}}, free, positions);

  EXPECT_EQ(fitted, (Matrix{{0.5, 0, 0, 2.5, 0, 0}, {0, 0, 0, 2, 0, 0}}));
  EXPECT_EQ(fitted_to_lengths({{0, 1, 2, true, false}}, free, positions), positions);
}

TEST(Begin, CountsWhatIsKnownByTheLengthOfAGap) {
  const Matrix data = column({1, nan, nan, nan, nan, 6, nan, 8});
  Matrix variance = Matrix::Constant(8, 1, 0.1);
  variance(2, 0) = infinite;
  const MotionPrior prior{.positions = Matrix::Constant(8, 1, 9), .variance = variance};

  const Example e(data, 0, prior);

  EXPECT_DOUBLE_EQ(e.state.prior_share(1, 0), 0.03 * 4 / 8);
  EXPECT_DOUBLE_EQ(e.state.prior_share(6, 0), 0.03 * 1 / 8);
  EXPECT_EQ(e.state.prior_share(2, 0), 0);  // nothing is known
  EXPECT_EQ(e.state.prior_share(0, 0), 0);  // observed
  EXPECT_EQ(filled(e.state), column({1, 9, 9, 9, 9, 6, 9, 8}));
  EXPECT_DOUBLE_EQ(e.state.floor, 1.25e-5);
}

TEST(LearnedAccelerations, AreClippedAtFirst) {
  Matrix motion = Matrix::Zero(42, 1);  // accelerations 1, -1, ... and a large one
  for (Index k = 0; k < 40; ++k)
    motion(k + 2, 0) = 2 * motion(k + 1, 0) - motion(k, 0) + (k == 39 ? 1000 : k % 2 == 0 ? 1 : -1);

  const Matrix a = learned_accelerations(Example(motion).state, motion);

  EXPECT_NEAR(a(39, 0), 5 * 1.4826, test::tolerance::two_texts());
  EXPECT_EQ(a(38, 0), 1);
}

TEST(LearnedAccelerations, HaveWeightsOfTheirPrecisionLater) {
  Example e(column({0, 1, 4, 9}), 6);  // accelerations 2, 2
  e.state.precision = Eigen::Vector2d(1, 16);

  const Matrix a = learned_accelerations(e.state, e.state.data);

  EXPECT_DOUBLE_EQ(a(0, 0), 2 / std::sqrt(2.5));
  EXPECT_DOUBLE_EQ(a(1, 0), 4 / std::sqrt(2.5));
}

TEST(DrawnToNearness, WeighsFramesSeenAgainstTenExpected) {
  Example e(test::random_matrix(12, 6, 1));  // ten accelerations
  EXPECT_EQ(e.state.nearness.size(), 0);
  e.state.nearness = Matrix::Identity(6, 6);
  e.state.nearness(0, 3) = e.state.nearness(3, 0) = 0.5;
  Matrix Q = Matrix::Ones(6, 6);
  Q.diagonal() << 4, 4, 4, 9, 9, 9;

  const Matrix with_prior = with_nearness_prior(e.state, Q);

  EXPECT_DOUBLE_EQ(with_prior(0, 3), (1 + 0.5 * 2 * 3) / 2);
  EXPECT_DOUBLE_EQ(with_prior(0, 4), 0.5);
  EXPECT_DOUBLE_EQ(with_prior(3, 3), 9);
}

TEST(DrawnToNearness, ExpectsMoreWhereSmoothingLeftLess) {
  Example e(test::random_matrix(12, 3, 1), 6);
  e.state.sigma = 2;
  e.state.nearness = Matrix::Identity(3, 3);
  const double left = kept_share(4, 1), expected = 10 + 50 * (1 - left);

  const Matrix with_prior = with_nearness_prior(e.state, Matrix::Ones(3, 3));

  EXPECT_DOUBLE_EQ(with_prior(0, 1), 1 - expected / (expected + 10 * left));
}

TEST(KeptShares, AreOfNoInterestWithoutNoise) {
  Example e(test::random_matrix(12, 3, 1), 2);

  EXPECT_FALSE(kept_shares(e.state));  // 0.25 of 1
  e.state.sigma = 2;
  EXPECT_DOUBLE_EQ((*kept_shares(e.state))(1), kept_share(4, 1));
  e.state.step = 6;
  e.state.weights.bottomRows(6).setZero();  // half of the samples tell half
  EXPECT_DOUBLE_EQ((*kept_shares(e.state))(1), kept_share(8, 1));
  e.state.step = 0;
  EXPECT_FALSE(kept_shares(e.state));
}

TEST(Ridged, AddsAShareOfTheMeanAndTheFloor) {
  Example e(test::random_matrix(6, 2, 1));
  const double floor = 1.25e-6 * 1.25e-6;

  const Eigen::VectorXd soft = ridged(e.state, Eigen::Vector2d(-1, 8));  // 0 and 2
  e.state.step = 6;
  const Eigen::VectorXd hard = ridged(e.state, Eigen::Vector2d(-1, 8));

  EXPECT_DOUBLE_EQ(soft(0), 0.02 + floor);
  EXPECT_DOUBLE_EQ(soft(1), 2.02 + floor);
  EXPECT_DOUBLE_EQ(hard(1), 2.001 + floor);
}

TEST(Weigh, IsSoftAtFirst) {
  const Matrix data = column({0, 0, 3, 0, nan, 0});
  Example e(data);

  const Terms terms = weigh(e.state, Matrix::Zero(6, 1), Matrix::Constant(1, 1, 2));  // 1/R = 1/2

  // Beside sigma^2: h / 6 halves, h = 1; the threshold is 8.
  const double energy = 9 / (0.25 + 0.5 / 6), W = 1 / std::pow(1 + energy / 64, 2);
  EXPECT_DOUBLE_EQ(e.state.weights(2, 0), W);
  EXPECT_DOUBLE_EQ(terms.weights(2, 0), W / (0.25 + 0.5 / 6));
  EXPECT_DOUBLE_EQ(terms.weights(1, 0), 1 / (0.25 + 0.5 / 6));
  EXPECT_EQ(terms.weights(4, 0), 0);
  EXPECT_EQ(terms.target(2, 0), 3);
}

TEST(Weigh, RejectsLater) {
  MotionPrior prior;
  prior.confirmed = Mask::Constant(7, 1, false);
  prior.confirmed(5, 0) = true;
  Example e(column({0, 0, 4, 0, 3, 9, 0}), 6, prior);
  e.state.floor = 1;  // no scales of accelerations

  const Terms terms = weigh(e.state, Matrix::Zero(7, 1), Matrix::Constant(1, 1, 2));

  // Six deviations are sqrt(36 (0.25 + 0.5 / 6)) = 3.46.
  EXPECT_EQ(e.state.weights, column({1, 1, 0, 1, 1, 1, 1}));
  EXPECT_EQ(terms.weights, column({4, 4, 0, 4, 4, 4, 4}));
  EXPECT_EQ(e.state.precision, Eigen::VectorXd::Ones(5));
  EXPECT_EQ(rejected(e.state, Matrix::Ones(7, 1)), column({0, 0, 3, 0, 0, 0, 0}));
}

TEST(Weigh, RaisesEnergiesToTheMedianOfTheJoint) {
  Matrix data = Matrix::Zero(6, 3);
  data.row(2) << 9, 9, 0;
  Example e(data, 6);
  e.method.joint_columns = 3;

  weigh(e.state, Matrix::Zero(6, 3), Matrix::Identity(3, 3));
  EXPECT_EQ(e.state.weights.row(2).sum(), 0);

  e.state.data.row(2) << 9, 0, 0;
  e.state.weights.setOnes();
  weigh(e.state, Matrix::Zero(6, 3), Matrix::Identity(3, 3));
  EXPECT_EQ(Matrix(e.state.weights.row(2)), (Matrix{{0, 1, 1}}));
}

TEST(Weigh, GivesAccelerationsTheirScale) {
  Example e(column({1, 0, 2, 5}), 6);  // accelerations 3, 1
  e.state.spectrum(0) = 4;
  e.state.precision = Eigen::Vector2d(1, 0.5);
  e.state.weights(0, 0) = 0.2;  // of 4 samples 3.2 are in use: of the first acceleration 2 of 3

  weigh(e.state, e.state.data, Matrix::Constant(1, 1, 0.25));

  EXPECT_DOUBLE_EQ(e.state.precision(0), 23 / (23 + 9. / 4));
  EXPECT_DOUBLE_EQ(e.state.precision(1), (3 + kept_share(0.25 / 0.8, 8)) / (3 + 1. / 4));
}

TEST(Weigh, DrawsMissingSamplesToWhereTheyShouldBe) {
  const MotionPrior prior{.positions = Matrix::Constant(6, 1, 7),
                          .variance = Matrix::Constant(6, 1, 1)};
  Example e(column({0, 0, nan, nan, 0, 0}), 2, prior);

  const Terms terms = weigh(e.state, Matrix::Zero(6, 1), Matrix::Identity(1, 1));

  EXPECT_DOUBLE_EQ(terms.weights(3, 0), 0.03 * 2 / 8 / (0.25 + 1));
  EXPECT_DOUBLE_EQ(terms.target(3, 0), 7);
  EXPECT_EQ(e.state.weights(3, 0), 0);
}

TEST(Weigh, BuildsOnLengthsInTheMiddleOfGaps) {
  Matrix data = Matrix::Zero(25, 6);
  data.block(5, 3, 15, 3).setConstant(nan);
  Matrix S = Matrix::Zero(25, 6);
  S.col(3).setConstant(3);
  MotionPrior prior;
  prior.links = {{0, 1, 2, true, true}};
  Example e(data, 6, prior);
  e.method.joint_columns = 3;

  const Terms terms = weigh(e.state, S, Matrix::Identity(6, 6));

  const double h = 8;  // frame 12, of the gap 5 to 19
  EXPECT_DOUBLE_EQ(terms.target(12, 3), 2);
  EXPECT_EQ(terms.target(12, 4), 0);
  EXPECT_DOUBLE_EQ(terms.weights(12, 3), 0.1 / (0.25 + h * h * h / 24));
  EXPECT_EQ(terms.weights(6, 3), 0);  // h = 2 2 14 / 16 is less than 4
  EXPECT_EQ(terms.weights(12, 0), 4);
}

TEST(EstimateNoise, IsTheMedianOverWhatSmoothingLeavesOfIt) {
  Example e(column({0.1, -0.2, 0.3, -0.4, 9}), 6);
  e.state.weights(4, 0) = 0;
  const double fitted = kept_share(0.25 / 0.8, 1);

  estimate_noise(e.state, Matrix::Zero(5, 1));

  EXPECT_DOUBLE_EQ(e.state.sigma, 1.4826 * 0.25 / std::sqrt(1 - fitted));
  EXPECT_EQ(e.state.step, 7);
}

TEST(EstimateNoise, WaitsForHalfOfTheSoftStepsAndAHundredResiduals) {
  Matrix data = Matrix::Constant(110, 1, 0.2);
  data.topRows(5).setConstant(9);  // more than three deviations
  Example e(data, 2);

  estimate_noise(e.state, Matrix::Zero(110, 1));
  EXPECT_EQ(e.state.sigma, 0.5);
  estimate_noise(e.state, Matrix::Zero(110, 1));
  EXPECT_DOUBLE_EQ(e.state.sigma, 1.4826 * 0.2);
}

TEST(Cleaned, KeepsSamplesInUseWhereThereIsNoNoise) {
  Example e(column({1, 2, 3, 4, 5}), 6);
  e.state.weights(2, 0) = 0;

  EXPECT_EQ(cleaned(e.state, Matrix::Zero(5, 1)), Matrix::Zero(5, 1));
  e.state.sigma = e.state.floor;
  EXPECT_EQ(cleaned(e.state, Matrix::Zero(5, 1)), column({1, 2, 0, 4, 5}));
}

TEST(NoiseLeft, IsTheDiagonalOfTheInverse) {
  const Eigen::VectorXd precision = test::random_matrix(28, 1, 1).col(0).cwiseAbs2();
  const Eigen::MatrixXd system = dense(smoothing_system(Eigen::VectorXd::Ones(30), precision, 50));

  EXPECT_LE(
      (noise_left(Eigen::VectorXd::Ones(30), precision, 50) - system.inverse().diagonal()).norm(),
      test::tolerance::two_texts());
}

TEST(JointInnovations, AreWhatTheOthersDoNotPredict) {
  Matrix Q(2, 2);
  Q << 5, 2, 2, 4;

  const JointInnovations own = joint_innovations(Matrix{{3, 8}}, Q, 1);

  EXPECT_DOUBLE_EQ(own.values(0, 0), 3 - 2. / 4 * 8);
  EXPECT_DOUBLE_EQ(own.values(0, 1), 8 - 2. / 5 * 3);
  EXPECT_DOUBLE_EQ(own.variance(0), 5 - 2. * 2 / 4);
  EXPECT_EQ(joint_innovations(Matrix{{3, 8}}, Q, 3).values, (Matrix{{3, 8}}));  // no others
}

TEST(VarianceGiven, IsThatOfTheColumnsNotInUse) {
  Matrix Q(2, 2);
  Q << 5, 2, 2, 4;

  const Eigen::VectorXd variance = variance_given(Mask{{false, true}}, Q.inverse());

  EXPECT_NEAR(variance(0), 4, test::tolerance::by_hand(4));
  EXPECT_EQ(variance(1), 0);
}

TEST(SharesInGap, AreOfTheSmoothestFill) {
  EXPECT_LE((shares_in_gap(1) - Eigen::Vector3d(1, -2, 1) / 6).norm(), test::tolerance::epsilon);

  const Eigen::VectorXd shares = shares_in_gap(15);

  // A straight line has no innovations; a kink of 1 in the middle of a gap is half of it.
  double line = 0;
  for (Index i = 0; i < shares.size(); ++i) line += shares(i) * static_cast<double>(i);
  EXPECT_NEAR(line, 0, test::tolerance::two_texts());
  EXPECT_NEAR(shares.sum(), 0, test::tolerance::two_texts());
}

TEST(Deviation, IsTheFloorAndMoreInGaps) {
  Example e(test::random_matrix(60, 3, 1), 10);
  e.state.sigma = e.state.floor = 1e-3;
  e.state.weights.block(20, 1, 5, 1).setZero();

  const Matrix sigma = deviation(e.state, Matrix::Zero(60, 3), Matrix::Identity(3, 3));

  EXPECT_DOUBLE_EQ(sigma(20, 0), 1e-3);
  EXPECT_GT(sigma(22, 1), sigma(20, 1));
  EXPECT_GT(sigma(20, 1), 1.5e-3);
  EXPECT_TRUE(
      deviation(Example(Matrix::Zero(3, 1)).state, Matrix::Zero(3, 1), {}).array().isNaN().all());
}

}  // namespace
}  // namespace moclean::reference
