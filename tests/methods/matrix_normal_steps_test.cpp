// The statistics of the device form against those of the reference, function by function and on the
// same input: another text of the same definitions (docs/decisions/independent-reference.md).
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "moclean/core/random.hpp"
#include "moclean/methods/matrix_normal/deviation.hpp"
#include "moclean/methods/matrix_normal/on_lengths.hpp"
#include "moclean/methods/matrix_normal/reference.hpp"
#include "moclean/methods/matrix_normal/reference_model.hpp"
#include "moclean/methods/matrix_normal/reference_sigma.hpp"
#include "moclean/methods/matrix_normal/window.hpp"

#include "support/matrix.hpp"
#include "support/model_motion.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;

constexpr double infinite = std::numeric_limits<double>::infinity();

// What is not finite is alike, and the rest up to rounding.
void expect_same(const Matrix& device, const Matrix& reference, const std::string& what) {
  ASSERT_EQ(device.rows(), reference.rows()) << what;
  ASSERT_EQ(device.cols(), reference.cols()) << what;
  const auto marks = [](const Matrix& m) {
    return m.array().isNaN().select(1,
                                    m.array().isInf().select(2, Matrix::Zero(m.rows(), m.cols())));
  };
  EXPECT_EQ(Matrix(marks(device)), Matrix(marks(reference))) << what;
  const auto finite = [](const Matrix& m) -> Matrix { return m.array().isFinite().select(m, 0); };
  EXPECT_LE(test::relative_difference(finite(device), finite(reference)),
            test::tolerance::two_texts())
      << what;
}

struct Case {
  std::string name;
  Matrix data;
  MatrixNormal method = {};
  MotionPrior prior = {};
};

// Motion with dense noise, gross errors and gaps.
Matrix spoilt_walk(Index frames, Index columns, double noise, std::uint64_t seed) {
  Matrix data = test::synthetic_walk(frames, seed).samples.leftCols(columns);
  Random random(seed);
  for (double& x : data.reshaped<Eigen::RowMajor>()) {
    x += noise * random.normal();
    if (random.uniform() < 0.05) x += 3 * random.normal();
    if (random.uniform() < 0.05) x = nan;
  }
  return data;
}

// Confirmed samples, exact links and others, places of missing samples in one half.
MotionPrior prior_of(const Matrix& data) {
  const Index joints = data.cols() / 3;
  MotionPrior prior{.size = 10, .noise = 0.05};
  prior.confirmed = test::random_matrix(data.rows(), joints, 5).array() > 1;
  for (Index j = 1; j < joints; ++j) prior.links.push_back({j - 1, j, 5, true, j % 3 != 0});
  prior.positions = test::random_matrix(data.rows(), data.cols(), 6);
  prior.variance = test::random_matrix(data.rows(), joints, 7).cwiseAbs2();
  prior.variance.topRows(data.rows() / 2).setConstant(infinite);
  return prior;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const double noise : {0., 0.02, 0.5})
    all.push_back({"walk, noise " + std::to_string(noise), spoilt_walk(150, 12, noise, 1)});
  all.push_back({"random", test::random_matrix(90, 9, 1)});
  all.push_back({"slow random", 1e-3 * test::random_matrix(90, 9, 2).array() + 1e3});
  all.push_back({"wide", spoilt_walk(12, 30, 0.02, 2)});
  all.push_back({"five frames", spoilt_walk(5, 6, 0.02, 3)});
  all.push_back({"one column", spoilt_walk(60, 1, 0.02, 4)});
  all.push_back({"trivial", spoilt_walk(4, 6, 0.02, 4)});
  all.push_back({"unseen", Matrix::Constant(30, 6, nan)});
  all.push_back({"constant", Matrix::Constant(30, 6, 3)});
  all.push_back({"rounded", (10 * spoilt_walk(200, 9, 0, 5)).array().round() / 10});

  Matrix data =
      test::synthetic_walk(80).samples.leftCols(12) + 0.02 * test::random_matrix(80, 12, 6);
  data.middleCols(3, 3).setZero();
  all.push_back({"a joint at zero", data});
  data = spoilt_walk(80, 12, 0.02, 6);
  data.col(7).setConstant(nan);
  all.push_back({"a column never seen", data});
  data = Matrix::Constant(40, 6, nan);
  data(7, 2) = 5;
  all.push_back({"one sample", data});
  data = spoilt_walk(160, 12, 0.02, 7);
  data.middleRows(50, 30).setConstant(nan);
  data.block(100, 3, 60, 3).setConstant(nan);
  all.push_back({"frames never seen, a gap that is open", data});
  data.block(10, 6, 25, 3).setConstant(nan);
  all.push_back({"known beforehand", data, {}, prior_of(data)});
  all.push_back({"known beforehand, noisy", spoilt_walk(150, 12, 0.5, 8), {}, prior_of(data)});
  all.back().prior = prior_of(all.back().data);
  data = spoilt_walk(120, 12, 0.3, 10);
  all.push_back({"of different confidence", data, {}, prior_of(data)});
  all.back().prior.confidence =
      test::random_matrix(120, 12, 11).cwiseAbs().cwiseMin(1).cwiseMax(0.05);
  all.push_back({"joints of two columns", spoilt_walk(80, 7, 0.1, 9), {.joint_columns = 2}});
  all.push_back({"no joints", spoilt_walk(80, 9, 0.5, 9), {.joint_columns = 1}});
  all.push_back({"one step each", spoilt_walk(80, 9, 0.2, 9), {.soft_steps = 1, .hard_steps = 1}});
  return all;
}

class MatrixNormalSteps : public testing::TestWithParam<std::size_t> {};

// Both get the S, Q and R of the reference in every step.
TEST_P(MatrixNormalSteps, AreThoseOfTheReference) {
  const Case own = cases()[GetParam()];
  SCOPED_TRACE(own.name);
  const MatrixNormal& method = own.method;
  MatrixNormalWindow window(own.data, method, own.prior);
  auto state = reference::begin(own.data, method, own.prior);
  const auto expect_result = [&](const Matrix& S, const Matrix& Z) {
    expect_same(window.trusted().cast<double>(), (state.weights.array() > 0).cast<double>(),
                "trust");
    expect_same(window.cleaned(S), reference::cleaned(state, S), "cleaned");
    expect_same(window.rejected(S.topRows(window.frames())),
                reference::rejected(state, S.topRows(window.frames())), "rejected");
    expect_same(window.deviation(S, Z), reference::deviation(state, S, Z), "deviation");
  };
  Matrix expected = reference::filled(state);
  reference::leave_unobserved(state, expected);
  expect_same(window.filled(), expected, "filled");
  if (window.trivial()) return expect_result(expected, {});

  const Index frames = window.frames(), rows = window.rows(), columns = window.columns();
  const auto guess = window.first_guess();
  const auto rough = reference::rough_motion(state);
  expect_same(guess.motion.topRows(frames), rough.motion, "first guess");
  expect_same(guess.stiffness, rough.stiffness, "stiffness");
  Matrix S = guess.motion, Z;
  for (int step = 0; step < window.steps(); ++step) {
    SCOPED_TRACE("step " + std::to_string(step));
    Matrix A = reference::learned_accelerations(state, S);
    expect_same(window.accelerations(S).topRows(frames - 2), A, "accelerations");
    expect_same(window.accelerations(S).bottomRows(rows - frames + 2),
                Matrix::Zero(rows - frames + 2, columns), "rows that are none");
    const auto growth = window.growth();
    const auto kept = reference::kept_shares(state);
    ASSERT_EQ(growth.has_value(), kept.has_value());
    if (kept) {
      expect_same(*growth, kept->cwiseSqrt().cwiseInverse(), "growth");
      A *= Z.transpose() * kept->cwiseSqrt().cwiseInverse().asDiagonal() * Z;
    }
    Matrix with_prior = A.transpose() * A;
    const Matrix Q = reference::with_nearness_prior(state, with_prior);
    window.add_prior(with_prior);
    expect_same(with_prior, Q, "Q");
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Q);
    Z = eigen.eigenvectors().transpose();
    state.spectrum = reference::ridged(state, eigen.eigenvalues());
    expect_same(window.inverse_spectrum(eigen.eigenvalues()), state.spectrum.cwiseInverse(), "e");
    const Matrix R = Z.transpose() * state.spectrum.cwiseInverse().asDiagonal() * Z;
    window.weigh(S, R);
    const auto terms = reference::weigh(state, S, R);
    const auto used = terms.weights.array() > 0;
    expect_same(window.weights().topRows(frames), terms.weights, "weights");
    expect_same(window.weights().bottomRows(rows - frames), Matrix::Zero(rows - frames, columns),
                "weights of rows that are none");
    expect_same(used.select(window.target().topRows(frames), 0), used.select(terms.target, 0),
                "targets");
    expect_same(window.precision().head(frames - 2), state.precision, "precision");
    reference::smooth(window.target(), window.weights(), window.precision(), R,
                      method.solve_iterations, method.tolerance(step), S);
    window.estimate_noise(S);
    reference::estimate_noise(state, S);
    expect_result(S, Z);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, MatrixNormalSteps, testing::Range<std::size_t>(0, cases().size()));

TEST(MatrixNormalSteps, KeepAsMuchPower) {
  for (double ratio = 1e-12; ratio < 1e13; ratio *= 7)
    EXPECT_NEAR(kept_power(3 * ratio, 3) / reference::kept_share(3 * ratio, 3), 1,
                test::tolerance::two_texts())
        << ratio;
}

TEST(MatrixNormalSteps, PutJointsOnTheSameLengths) {
  Matrix positions = test::random_matrix(40, 15, 1);
  positions.row(7).setZero();  // all at one place
  const Mask free = test::random_matrix(40, 5, 2).array() > -0.5;
  const std::vector<DistanceLink> links = {{0, 1, 2, true, true},
                                           {1, 2, 0.5, true, true},
                                           {2, 3, 1, true, false},
                                           {4, 2, 3, false, true}};
  const Matrix expected = reference::fitted_to_lengths(links, free, positions);

  const Mask moved = put_on_lengths(links, free, positions);

  expect_same(positions, expected, "positions");
  for (const Index joint : {0, 1, 2, 4}) EXPECT_TRUE((moved.col(joint) == free.col(joint)).all());
  EXPECT_FALSE(moved.col(3).any());
}

// An estimate of random motion in which `lost` is not in use, in the form of either.
struct Estimate {
  Estimate(Index frames, Index columns, const Mask& used, double noise, bool has_prior,
           Index joint_columns)
      : method{.joint_columns = joint_columns} {
    const test::ModelMotion model = test::model_motion(frames, columns, 1);
    device = {.motion = model.motion,
              .used = used,
              .rejected = used.select(0, 5 * test::random_matrix(frames, columns, 3)),
              .prior_variance = Matrix::Constant(frames, columns, infinite),
              .eigenvectors = model.eigenvectors,
              .spectrum = model.spectrum,
              .precision = test::random_matrix(frames - 2, 1, 4).col(0).cwiseAbs2(),
              .noise = noise,
              .size = 10,
              .floor = 1e-4,
              .joint_columns = joint_columns,
              .has_prior = has_prior};
    const Mask missing = test::random_matrix(frames, columns, 8).array() > 0 && !used;
    device.rejected = missing.select(0, device.rejected);
    device.prior_variance =
        missing.select(test::random_matrix(frames, columns, 9).cwiseAbs2(), device.prior_variance);
    state.method = &method;
    state.prior = &prior;
    state.data = model.motion + device.rejected;
    state.observed = !missing;
    state.prior_variance = device.prior_variance;
    if (has_prior) state.nearness = Matrix::Identity(columns, columns);
    state.size = device.size;
    state.floor = device.floor;
    state.sigma = noise;
    state.step = 1;
    state.weights = used.cast<double>();
    state.confidence = Matrix::Ones(frames, columns);
    state.precision = device.precision;
    state.spectrum = model.spectrum;
  }

  MatrixNormal method;
  MotionPrior prior;
  MotionEstimate device;
  reference::SmoothingState state;
};

TEST(MatrixNormalDeviation, IsThatOfTheReference) {
  struct Shape {
    Index frames, columns, joint_columns;
  };
  for (const auto& [frames, columns, width] :
       {Shape{3, 3, 3}, Shape{5, 1, 1}, Shape{40, 7, 2}, Shape{8, 30, 3}, Shape{600, 9, 3}}) {
    std::vector<Mask> used(4, test::random_matrix(frames, columns, 2).array() > -1);
    used[1].setConstant(true);
    used[2].setConstant(false);
    used[3].middleRows(1, frames / 2).setConstant(false);
    used[3].col(0).setConstant(false);
    for (std::size_t k = 0; k < used.size(); ++k)
      for (const double noise : {1e-4, 0.03, 1.})
        for (const bool has_prior : {true, false}) {
          Estimate e(frames, columns, used[k], noise, has_prior, width);
          if (k == 0)
            e.state.confidence = e.device.confidence =
                test::random_matrix(frames, columns, 12).cwiseAbs().cwiseMax(0.05);
          Matrix expected = reference::deviation(e.state, e.device.motion, e.device.eigenvectors);
          Matrix stated = marginal_deviation(e.device);
          for (Index j = 0; j < columns; ++j)  // where the window leaves a column missing
            if (!e.state.observed.col(j).any()) stated.col(j).setConstant(nan);
          expect_same(stated, expected,
                      std::to_string(frames) + " x " + std::to_string(columns) + ", mask " +
                          std::to_string(k) + ", noise " + std::to_string(noise));
        }
  }
}

TEST(MatrixNormalDeviation, HasThePartsOfTheReference) {
  const Eigen::VectorXd precision = test::random_matrix(58, 1, 1).col(0).cwiseAbs2();
  const Eigen::Vector3d ratios(1e-6, 1, 1e6);
  const Matrix left = variance_left(ratios, precision, Eigen::VectorXd::Ones(precision.size() + 2));
  for (Index k = 0; k < 3; ++k)
    expect_same(left.col(k), reference::noise_left(Eigen::VectorXd::Ones(60), precision, ratios(k)),
                "noise left");

  const Matrix half = test::random_matrix(9, 9, 1);
  const Matrix Q = half * half.transpose() + Matrix::Identity(9, 9);
  const Matrix R = Q.inverse();
  for (const Index lost : {0, 1, 4, 8, 9}) {
    Mask used = Mask::Constant(1, 9, true);
    used.leftCols(lost).setConstant(false);
    expect_same(conditional_variance(Q, R, used.row(0).transpose()),
                reference::variance_given(used, R), "conditional variance");
  }
}

}  // namespace
}  // namespace moclean
