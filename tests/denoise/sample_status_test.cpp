#include "moclean/denoise/sample_status.hpp"

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::nan;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

// Six frames at 2 Hz of one joint and a column of its own.
Recording take_of(Matrix samples) {
  return {.samples = std::move(samples),
          .columns = {"hip.x", "hip.y", "hip.z", "force"},
          .frame_rate = 2,
          .unit = ""};
}

// A result that is 1 everywhere, of a take that is 1 but for the given outliers.
Denoised result_of(const Recording& take) {
  Denoised result;
  result.motion = Matrix::Ones(take.samples.rows(), take.samples.cols());
  result.outliers = take.samples.array().isNaN().select(0, take.samples.array() - 1);
  return result;
}

StatusCounts counts_of(const Recording& take, const Denoised& result) {
  return count_status(take, result, trusted_samples(take, result));
}

Matrix numbers_of(const Recording& take, const Denoised& result) {
  return status_numbers(take, result, trusted_samples(take, result));
}

TEST(SampleStatus, SaysWhatBecameOfASample) {
  Recording take = take_of(Matrix::Ones(6, 4));
  take.samples.row(2) << 1, 4, nan, nan;
  Denoised result = result_of(take);
  result.motion(2, 3) = nan;

  const Matrix status = numbers_of(take, result);

  EXPECT_THAT(std::vector<double>(status.row(2).begin(), status.row(2).end()),
              ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(counts_of(take, result), ElementsAre(21, 1, 1, 1));
}

TEST(SampleStatus, TakesWhatIsWithinSigmaForKept) {
  Recording take = take_of(Matrix::Ones(6, 4));
  take.samples.row(0) << 1.5, 0.4, 1, 3;
  Denoised result = result_of(take);
  result.sigma = Matrix::Constant(6, 4, 0.55);

  EXPECT_THAT(counts_of(take, result), ElementsAre(22, 2, 0, 0));
}

TEST(SampleStatus, BelievesTheMethodThatSaysWhatItTrusted) {
  Recording take = take_of(Matrix::Constant(6, 4, 1.5));
  take.samples(1, 0) = nan;
  Denoised result = result_of(take);
  result.trusted = Mask::Constant(6, 4, true);
  (*result.trusted)(0, 2) = false;

  const Matrix status = numbers_of(take, result);

  EXPECT_EQ(status(0, 2), 1);
  EXPECT_EQ(status(1, 0), 2);
  EXPECT_THAT(counts_of(take, result), ElementsAre(22, 1, 1, 0));
}

TEST(SampleStatus, CountsWhatItNumbers) {
  Recording take = take_of(Matrix::Random(6, 4));
  take.samples(0, 0) = take.samples(3, 1) = take.samples(5, 3) = nan;
  Denoised result = result_of(take);
  result.motion(3, 1) = result.motion(4, 2) = nan;
  result.outliers.row(2).setZero();

  const Matrix numbers = numbers_of(take, result);

  const StatusCounts counts = counts_of(take, result);
  for (std::size_t s = 0; s < counts.size(); ++s)
    EXPECT_EQ((numbers.array() == static_cast<double>(s)).count(), counts[s]) << s;
}

TEST(LeaveLongGaps, LeavesGapsThatAreLonger) {
  Recording take = take_of(Matrix::Ones(6, 4));
  take.samples.col(3) << nan, nan, 1, nan, nan, nan;  // 1 s, 1.5 s
  Denoised result = result_of(take);

  leave_long_gaps(take, 1, result);

  EXPECT_THAT(counts_of(take, result), ElementsAre(19, 0, 2, 3));
  EXPECT_TRUE(result.motion.col(3).tail(3).array().isNaN().all());
  EXPECT_EQ(result.motion(0, 3), 1);
}

TEST(LeaveLongGaps, TakesTheChannelsOfAJointTogether) {
  Recording take = take_of(Matrix::Ones(6, 4));
  take.samples(1, 0) = take.samples(2, 1) = take.samples(3, 2) = nan;  // three frames lack one
  take.samples(1, 3) = nan;
  Denoised result = result_of(take);
  result.sigma = result.motion;

  leave_long_gaps(take, 1, result);

  const Mask expected =
      take.samples.array().isNaN() &&
      (Mask(6, 4) << Mask::Constant(6, 3, true), Mask::Constant(6, 1, false)).finished();
  EXPECT_TRUE((result.motion.array().isNaN() == expected).all());
  EXPECT_TRUE((result.sigma->array().isNaN() == expected).all());
}

TEST(LeaveLongGaps, LeavesEveryGapWithoutATime) {
  Recording take = take_of(Matrix::Ones(6, 4));
  take.samples(1, 3) = nan;
  Denoised result = result_of(take);

  leave_long_gaps(take, 0, result);

  EXPECT_TRUE((result.motion.array().isNaN() == take.samples.array().isNaN()).all());
}

TEST(KeepObserved, PutsTrustedSamplesBack) {
  Recording take = take_of(Matrix::Constant(6, 4, 1.25));
  take.samples.row(2) << 4, nan, 1.25, 1.25;
  Denoised result = result_of(take);
  result.trusted = take.samples.array() < 2;

  const StatusCounts before = counts_of(take, result);
  keep_observed(take, trusted_samples(take, result), result);

  Matrix expected = take.samples;
  expected.row(2) << 1, 1, 1.25, 1.25;
  EXPECT_TRUE(test::same_bits(result.motion, expected));
  EXPECT_EQ(result.outliers(2, 0), 3);
  EXPECT_EQ(result.outliers.cwiseAbs().sum(), 3);
  EXPECT_EQ(counts_of(take, result), before);
}

TEST(SampleStatus, RefusesWhatDoesNotFit) {
  const Recording take = take_of(Matrix::Ones(6, 4));
  Recording rateless = take;
  rateless.frame_rate = 0;
  Denoised result = result_of(take);
  Denoised shorter = result_of(excerpt(take, 0, 5));

  EXPECT_THAT([&] { trusted_samples(take, shorter); },
              ThrowsMessage<ShapeError>(HasSubstr("5 frames x 4 columns, the take 6 x 4")));
  EXPECT_THROW(leave_long_gaps(take, 1, shorter), ShapeError);
  EXPECT_THROW(leave_long_gaps(take, -1, result), ArgumentError);
  EXPECT_THROW(leave_long_gaps(rateless, 1, result), ArgumentError);
}

}  // namespace
}  // namespace moclean
