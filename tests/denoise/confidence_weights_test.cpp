#include "moclean/denoise/confidence_weights.hpp"

#include <gtest/gtest.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/denoise/automatic.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean {
namespace {

using test::nan;

Recording sure_take(const Matrix& confidence) {
  return {.samples = Matrix::Zero(confidence.rows(), confidence.cols()),
          .columns = default_column_names(confidence.cols()),
          .unit = "",
          .confidence = confidence};
}

TEST(ConfidenceWeights, AreSharesOfTheSurest) {
  Matrix confidence = Matrix::Constant(40, 1, 0.8);
  confidence(3, 0) = 0.4;
  confidence(4, 0) = 0.95;  // surer than all others: counts as they do
  confidence(5, 0) = 0.001;
  confidence(6, 0) = nan;

  const Matrix weights = confidence_weights(sure_take(confidence));

  EXPECT_EQ(weights(0, 0), 1);
  EXPECT_DOUBLE_EQ(weights(3, 0), 0.5);  // samples without noise show nothing
  EXPECT_EQ(weights(4, 0), 1);
  EXPECT_EQ(weights(5, 0), 0.05);
  EXPECT_EQ(weights(6, 0), 1);
}

TEST(ConfidenceWeights, AreNoneWhereAllAreAsSure) {
  EXPECT_EQ(confidence_weights(sure_take(Matrix::Constant(9, 3, 0.7))).size(), 0);
  EXPECT_EQ(confidence_weights(sure_take(Matrix::Constant(9, 3, nan))).size(), 0);
  EXPECT_EQ(confidence_weights(sure_take(Matrix(0, 0))).size(), 0);
}

TEST(ConfidenceWeights, DoNotLookAtMissingSamples) {
  Recording take = sure_take(Matrix::Constant(10, 1, 0.5));
  take.confidence.topRows(4).setConstant(100);
  take.samples.topRows(4).setConstant(nan);

  EXPECT_EQ(confidence_weights(take).size(), 0);
}

// Noise of variance 1 / confidence^power, on 30 columns of a walk.
Recording noisy_walk(const Matrix& confidence, double power, double deviation) {
  const Matrix truth = test::synthetic_walk(confidence.rows()).samples.leftCols(confidence.cols());
  const Matrix noise = test::random_matrix(confidence.rows(), confidence.cols(), 3).array() *
                       confidence.array().pow(-power / 2);
  Recording take = sure_take(confidence);
  take.samples = truth + deviation * noise;
  return take;
}

TEST(ConfidenceExponent, IsWhatTheNoiseShows) {
  Matrix confidence =
      test::random_matrix(300, 30, 5).cwiseAbs().cwiseMax(0.06).cwiseMin(1);  // frame by frame
  for (const bool in_runs : {false, true}) {
    if (in_runs)
      for (Index i = 0; i < 300; ++i) confidence.row(i) = confidence.row(i / 20 * 20);
    EXPECT_NEAR(confidence_exponent(noisy_walk(confidence, 1, 0.3)), 1, 0.15) << in_runs;
    EXPECT_NEAR(confidence_exponent(noisy_walk(confidence, 0.5, 0.3)), 0.5, 0.15) << in_runs;
    EXPECT_LE(confidence_exponent(noisy_walk(confidence, 0, 0.3)), 0.15) << in_runs;
    EXPECT_EQ(confidence_exponent(noisy_walk(confidence, -1, 0.3)), 0) << in_runs;
  }
}

TEST(ConfidenceExponent, IsOneWhereThereIsHardlyAnythingToSee) {
  Matrix confidence = Matrix::Constant(60, 3, 0.9);
  confidence.row(20).setConstant(0.1);

  EXPECT_EQ(confidence_exponent(noisy_walk(confidence, 0, 0.3)), 1);
}

// Noise of five times the deviation where the confidence says so; of a walk that has no body.
TEST(Automatic, WeighsByConfidenceUnlessToldNotTo) {
  const Matrix truth = test::synthetic_walk(240).samples.leftCols(24);
  Recording take{.samples = truth,
                 .columns = default_column_names(24),
                 .frame_rate = 120,
                 .unit = "",
                 .confidence = Matrix::Constant(240, 24, 0.9)};
  for (Index i = 0; i < 240; ++i)
    for (Index j = 0; j < 24; ++j)
      if ((i + j / 3) % 2 == 0) take.confidence(i, j) = 0.036;
  take.samples += 0.05 * test::random_matrix(240, 24, 3).cwiseQuotient(take.confidence.cwiseSqrt());
  ReferenceBackend backend;
  const auto off = [&](const Recording& recording, const Automatic& method) {
    const std::vector<Recording> takes = {recording};
    return (AutomaticDenoiser(method, backend).denoise(takes)[0].motion - truth).norm();
  };
  Recording untold = take;
  untold.confidence = {};

  const double weighed = off(take, {}), unweighed = off(untold, {});

  EXPECT_LT(weighed, 0.8 * unweighed);
  EXPECT_EQ(off(take, {.confidence = Confidence::off}), unweighed);
}

}  // namespace
}  // namespace moclean
