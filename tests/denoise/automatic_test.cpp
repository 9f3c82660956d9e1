#include "moclean/denoise/automatic.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"
#include "moclean/filter/filter.hpp"

#include "support/correlated_noise.hpp"
#include "support/limbs.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean {
namespace {

using test::nan;

Recording limbs(Index frames, double rate = 120) {
  const Matrix samples = test::swinging_limbs(frames, 8);
  return {.samples = samples, .columns = default_column_names(24), .frame_rate = rate, .unit = ""};
}

// Whole joints off by a constant for `length` frames.
Recording with_bursts(Recording clip, Index length) {
  Random random(3);
  for (Index first = 40; first + length < clip.frames(); first += 2 * length) {
    const auto joint = static_cast<Index>(random.uniform() * 8);
    for (Index c = 0; c < 3; ++c) {
      const double by = (random.uniform() < 0.5 ? -1 : 1) * (0.5 + random.uniform());
      clip.samples.col(3 * joint + c).segment(first, length).array() += by;
    }
  }
  return clip;
}

double rms(const Matrix& motion, const Recording& truth) {
  return (motion - truth.samples).norm() / std::sqrt(static_cast<double>(motion.size()));
}

Denoised cleaned(const Recording& clip, const Automatic& method = {}) {
  ReferenceBackend backend(2);
  return AutomaticDenoiser(method, backend).denoise(std::vector{clip})[0];
}

TEST(Automatic, RemovesBurstsThatOutlastAnyMedian) {
  const Recording truth = limbs(600), noisy = with_bursts(truth, 30);

  const Denoised result = cleaned(noisy);

  EXPECT_LE(rms(result.motion, truth), 0.05 * rms(filtered(noisy, MedianFilter{}), truth));
  EXPECT_LE(rms(result.motion, truth),
            0.2 * rms(cleaned(noisy, {.body = BodyRules::off}).motion, truth));
}

TEST(Automatic, TellsOfEverySampleWhetherItWasTrusted) {
  const Recording truth = limbs(400), noisy = with_bursts(truth, 25);

  const Denoised result = cleaned(noisy);

  const Mask wrong = (noisy.samples - truth.samples).array().abs() > 1e-9;
  EXPECT_FALSE((wrong && *result.trusted).any());
  const Mask right = !wrong;
  EXPECT_GE(static_cast<double>((right && *result.trusted).count()),
            0.95 * static_cast<double>(right.count()));
  const Matrix sum = result.motion + result.outliers;
  EXPECT_LE((wrong.select(sum - noisy.samples, 0)).norm(), 1e-12);
  EXPECT_TRUE((result.sigma->array() > 0).all());
}

TEST(Automatic, FillsGapsAndZeros) {
  const Recording truth = limbs(400);
  Recording gappy = truth;
  gappy.samples.block(100, 6, 30, 3).setConstant(nan);
  gappy.samples.block(200, 12, 30, 3).setZero();

  const Denoised result = cleaned(gappy);

  EXPECT_TRUE(result.motion.allFinite());
  EXPECT_LE(rms(result.motion, truth), 0.02);
}

TEST(Automatic, TakesNoiseAwayThatNeighbouringFramesShare) {
  const Index joints = 16;
  Recording truth = limbs(600);
  truth.samples = test::swinging_limbs(600, joints);
  truth.columns = default_column_names(3 * joints);
  Recording noisy = truth;
  noisy.samples += 0.05 * test::correlated_noise(600, 3 * joints, 0.8);

  const double left = rms(cleaned(noisy).motion, truth);

  EXPECT_LE(left, 0.8 * rms(noisy.samples, truth));
  EXPECT_LE(left, 0.85 * rms(cleaned(noisy, {.body = BodyRules::off}).motion, truth));
}

TEST(Automatic, NeighboursCarryAMarkerThroughALongGap) {
  // Markers on one solid that turns, each sliding a little: no distance is exact.
  constexpr Index frames = 400;
  Recording truth = limbs(frames);
  for (Index i = 0; i < frames; ++i)
    for (Index j = 0; j < 8; ++j) {
      const double t = static_cast<double>(i) / 120, k = static_cast<double>(j);
      const double turn = 1.5 * std::sin(2 * t) + 0.4 * std::sin(5 * t),
                   slide = 0.03 * std::sin(t + k);
      const double x = 3 * std::cos(2 * k) + slide, y = 3 * std::sin(3 * k);
      truth.samples.row(i).segment<3>(3 * j) << x * std::cos(turn) - y * std::sin(turn) + t,
          x * std::sin(turn) + y * std::cos(turn), 2 * std::cos(5 * k) - slide;
    }
  Recording gappy = truth;
  gappy.samples.middleRows(150, 90).middleCols(6, 3).setConstant(nan);

  const Denoised result = cleaned(gappy), blind = cleaned(gappy, {.body = BodyRules::off});

  const auto gap_of = [](const Matrix& samples) { return samples.block(150, 6, 90, 3); };
  EXPECT_LE((gap_of(result.motion) - gap_of(truth.samples)).norm(),
            3 * gap_of(*result.sigma).norm());
  EXPECT_LE(gap_of(*result.sigma).norm(), 0.5 * gap_of(*blind.sigma).norm());
}

TEST(Automatic, LeavesAPoseBeforeTheMotionAlone) {
  const Recording motion = with_bursts(limbs(300), 30);
  Recording take = motion;
  take.samples.resize(301, Eigen::NoChange);
  take.samples << test::swinging_limbs(1, 8, 2), motion.samples;

  const Denoised result = cleaned(take);

  EXPECT_EQ(result.segments.size(), 2);
  EXPECT_TRUE(result.motion.row(0) == take.samples.row(0));
  const Matrix alone = cleaned(motion).motion;
  EXPECT_LE((result.motion.bottomRows(300) - alone).norm(), 0.02);
}

TEST(Automatic, LeavesNoJointMissingThatWasSeen) {
  // Out of place in all of the second window, frames 95 to 205: flags would leave nothing of it.
  Recording noisy = limbs(400);
  noisy.samples.block(90, 15, 120, 3).array() += 0.7;

  const Denoised result = cleaned(noisy, {.window = 100, .overlap = 10});

  EXPECT_TRUE(result.motion.allFinite());
}

TEST(Automatic, ScalesWithTheUnitOfLength) {
  const Recording noisy = with_bursts(limbs(300), 20);
  const Matrix expected = cleaned(noisy).motion;

  for (const double scale : {1e-3, 1e3, 1e-301, 1e200}) {
    Recording scaled = noisy;
    scaled.samples *= scale;
    EXPECT_LE(test::relative_difference(cleaned(scaled).motion / scale, expected), 1e-9);
  }
}

TEST(Automatic, ShiftsWithTheOrigin) {
  const Recording noisy = with_bursts(limbs(300), 20);
  const Denoised expected = cleaned(noisy);

  Recording moved = noisy;
  moved.samples.array() += 1e4;
  const Denoised result = cleaned(moved);

  EXPECT_LE((result.motion.array() - 1e4 - expected.motion.array()).abs().maxCoeff(), 1e-9 * 1e4);
  EXPECT_TRUE((*result.trusted == *expected.trusted).all());
}

Matrix reversed(const Matrix& samples) { return samples.colwise().reverse(); }

Recording reversed(const Recording& clip) { return like(clip, reversed(clip.samples)); }

Matrix reordered(const Matrix& samples) {
  Matrix result = samples;
  for (Index j = 0; j < 8; ++j) result.middleCols<3>(3 * j) = samples.middleCols<3>(3 * (7 - j));
  return result;
}

Recording reordered(const Recording& clip) { return like(clip, reordered(clip.samples)); }

Recording with_noise(Recording clip, double deviation) {
  Random random(3);
  for (double& x : clip.samples.reshaped()) x += deviation * random.normal();
  return clip;
}

TEST(Automatic, PlaysBackward) {
  const Recording noisy = with_noise(limbs(300), 0.01);
  const Matrix expected = cleaned(noisy).motion;

  const Matrix result = reversed(cleaned(reversed(noisy)).motion);

  EXPECT_LE(test::relative_difference(result, expected), 1e-9);
}

TEST(Automatic, DoesNotDependOnTheOrderOfJoints) {
  const Recording noisy = with_noise(limbs(300), 0.01);
  const Matrix expected = cleaned(noisy).motion;

  const Matrix result = reordered(cleaned(reordered(noisy)).motion);

  EXPECT_LE(test::relative_difference(result, expected), 1e-9);
}

// What fills a gap is learned from trials spread over the take, and lengths are put right one after
// the other: there direction and order count, a thousandth of a bone or so.
TEST(Automatic, FillsAlikeInAnyDirectionAndOrder) {
  const Recording noisy = with_bursts(limbs(300), 20);
  const Denoised expected = cleaned(noisy);

  const Matrix backward = reversed(cleaned(reversed(noisy)).motion);
  const Matrix other = reordered(cleaned(reordered(noisy)).motion);

  const Mask corrected = !*expected.trusted;
  const auto rms = [&](const Matrix& x) {
    return std::sqrt(corrected.select(x.array().square(), 0).sum() /
                     static_cast<double>(corrected.count()));
  };
  ASSERT_GT(corrected.count(), 100);
  EXPECT_LE(rms(backward - expected.motion), 2e-3);
  EXPECT_LE(rms(other - expected.motion), 2e-3);
}

// Without the joints that stand still, the same bits.
TEST(Automatic, JointsAtRestStayAndHaveNoSay) {
  const Recording moving = with_bursts(limbs(300), 20);
  Recording take = moving;
  take.samples = Matrix::Zero(300, 24 + 3 * 20);
  take.samples.leftCols(24) = moving.samples;
  take.samples.middleCols<3>(24).rowwise() = Eigen::RowVector3d(0.1, 2.3, 4.7);
  take.samples.block<40, 3>(100, 24).setConstant(nan);
  take.columns = default_column_names(84);

  const Denoised result = cleaned(take), expected = cleaned(moving);

  EXPECT_TRUE(test::same_bits(result.motion.leftCols(24), expected.motion));
  EXPECT_TRUE((result.motion.rightCols(57).array() == 0).all());
  EXPECT_TRUE((result.motion.col(25).array() == 2.3).all());
  EXPECT_TRUE(result.trusted->rightCols(57).all());

  take.samples.leftCols(24).rowwise() = moving.samples.row(0).eval();
  const Denoised still = cleaned(take);
  EXPECT_TRUE((still.motion.col(3).array() == moving.samples(0, 3)).all());
  EXPECT_TRUE(still.segments.empty());
}

TEST(Automatic, RejectsNothingWhereItIsTold) {
  Recording noisy = with_bursts(limbs(300), 20);
  noisy.samples.block(200, 12, 30, 3).setZero();

  const Denoised none = cleaned(noisy, {.reject = Rejection::off});
  const Denoised gentle = cleaned(noisy, {.reject = Rejection::gentle});
  const Denoised usual = cleaned(noisy, {.reject = Rejection::on});

  EXPECT_TRUE(none.trusted->all());
  EXPECT_TRUE((none.outliers.array() == 0).all());
  EXPECT_FALSE(gentle.trusted->block(200, 12, 30, 3).any());
  EXPECT_GT(gentle.trusted->count(), usual.trusted->count());
  EXPECT_LT(gentle.trusted->count(), none.trusted->count());
}

TEST(Automatic, LeavesTrustedSamplesAloneWhereItIsNotToSmooth) {
  Recording noisy = with_bursts(limbs(300), 20);
  Random random(8);
  for (double& x : noisy.samples.reshaped()) x += 0.01 * random.normal();
  noisy.samples.block(250, 3, 20, 3).setConstant(nan);
  const Denoised smoothed = cleaned(noisy);

  const Denoised result = cleaned(noisy, {.smooth = Smoothing::off});

  const Mask& trusted = *result.trusted;
  EXPECT_TRUE((trusted == *smoothed.trusted).all());
  EXPECT_GT(trusted.count(), trusted.size() / 2);
  EXPECT_TRUE((!trusted || result.motion.array() == noisy.samples.array()).all());
  EXPECT_TRUE((trusted || result.motion.array() == smoothed.motion.array()).all());
}

TEST(Automatic, RefusesAMatrixThatIsNoMotion) {
  Random random(4);
  Recording matrix = limbs(200);
  for (double& x : matrix.samples.reshaped()) x = random.normal();
  ReferenceBackend backend;
  AutomaticDenoiser denoiser({}, backend);

  try {
    denoiser.denoise(std::vector{limbs(60), matrix});
    FAIL();
  } catch (const TakeError& error) {
    EXPECT_EQ(error.take(), 1);
    EXPECT_THAT(error.problem(), testing::HasSubstr("rpca"));
    EXPECT_THAT(error.what(), testing::StartsWith("take 1: its rows are not smooth in time"));
  }
}

TEST(Automatic, ClaimsNeitherRankNorConvergence) {
  const SegmentOutcome outcome = cleaned(limbs(60)).segments.at(0).outcome;

  EXPECT_FALSE(outcome.rank);
  EXPECT_FALSE(outcome.converged);
  EXPECT_TRUE(outcome.fixed_steps);
  EXPECT_FALSE(fell_short(outcome));
  EXPECT_GT(outcome.iterations, 0);
}

TEST(Automatic, WindowsLeaveNoSeam) {
  const Recording truth = test::synthetic_walk(700);
  Recording noisy = truth;
  Random random(5);
  for (Index i = 0; i < noisy.samples.size(); ++i)
    if (random.uniform() < 0.1) noisy.samples.data()[i] += 2 * random.normal();

  const Denoised result = cleaned(noisy, {.window = 230, .overlap = 60});

  ASSERT_EQ(result.segments.size(), 3u);
  const Matrix error = result.motion - truth.samples;
  std::vector<double> elsewhere;
  double at_seams = 0;
  for (Index i = 1; i + 1 < error.rows(); ++i) {
    const double a = (error.row(i - 1) - 2 * error.row(i) + error.row(i + 1)).cwiseAbs().maxCoeff();
    // The boundaries 233 and 466, and where the 60 frames that windows share begin and end.
    bool seam = false;
    for (const Index boundary : {233, 466})
      for (const Index at : {boundary - 30, boundary, boundary + 30})
        seam = seam || std::abs(i - at) <= 1;
    if (seam)
      at_seams = std::max(at_seams, a);
    else
      elsewhere.push_back(a);
  }
  std::ranges::sort(elsewhere);
  EXPECT_LE(at_seams, elsewhere[elsewhere.size() * 99 / 100]);
}

TEST(Automatic, ResultsDoNotDependOnOtherTakesOrJobs) {
  const std::vector<Recording> takes = {with_bursts(limbs(200), 20), limbs(130, 30),
                                        test::synthetic_walk(90), with_bursts(limbs(170), 10)};
  ReferenceBackend backend(2);

  const auto together = AutomaticDenoiser({}, backend, 3).denoise(takes);

  for (std::size_t t = 0; t < takes.size(); ++t)
    EXPECT_TRUE(test::same_bits(together[t].motion, cleaned(takes[t]).motion)) << t;
}

TEST(Automatic, TakesWhateverComes) {
  Recording unseen = limbs(60);
  unseen.samples.col(4).setConstant(nan);
  const Denoised result = cleaned(unseen);
  EXPECT_TRUE(result.motion.col(4).array().isNaN().all());
  EXPECT_EQ(result.unobserved, std::vector<std::string>{unseen.columns[4]});

  for (const Index frames : {1, 2, 3, 10}) EXPECT_TRUE(cleaned(limbs(frames)).motion.allFinite());
  Recording plain{.samples = test::synthetic_walk(80).samples.leftCols(5),
                  .columns = {"a", "b", "c", "d", "e"},
                  .frame_rate = 0,
                  .unit = ""};
  EXPECT_LE(rms(cleaned(plain).motion, plain), 1e-3);
  plain.samples(3, 2) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(cleaned(plain), ShapeError);
}

TEST(Automatic, RefusesParametersOutOfRange) {
  EXPECT_THROW(cleaned(limbs(20), {.window = 7}), ArgumentError);
  EXPECT_THROW(cleaned(limbs(20), {.overlap = -1}), ArgumentError);
}

}  // namespace
}  // namespace moclean
