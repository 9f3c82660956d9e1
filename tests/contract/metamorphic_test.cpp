// What a change of the take does to the result, whatever the right result is: every step, on both
// backends. Defaults throughout.

#include <functional>

#include <gmock/gmock.h>

#include "contract/cleaner.hpp"
#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean::test {
namespace {

// Of the take's samples, all of them below 25.
constexpr double magnitude = 25;

double change(const Matrix& a, const Matrix& b) { return largest_difference(a, b) / magnitude; }

Matrix reversed_in_time(const Matrix& m) { return m.colwise().reverse(); }

Matrix joints_backwards(const Matrix& m) {
  Matrix result(m.rows(), m.cols());
  const Index count = m.cols() / 3;
  for (Index j = 0; j < count; ++j)
    result.middleCols(3 * j, 3) = m.middleCols(3 * (count - 1 - j), 3);
  return result;
}

Matrix beside(const Matrix& left, const Matrix& right) {
  Matrix result(left.rows(), left.cols() + right.cols());
  result << left, right;
  return result;
}

class Metamorphic : public ::testing::TestWithParam<Cleaner> {
 protected:
  Matrix motion(const Matrix& samples) const { return GetParam().motion(take_of(samples)); }

  const Matrix samples_ = noisy_limbs().samples;
  const Matrix expected_ = motion(samples_);
};

TEST_P(Metamorphic, ADoubledUnitDoublesTheResultToTheLastBit) {
  for (const double factor : {0x1p10, 0x1p-10, 0x1p60, 0x1p-60})
    EXPECT_TRUE(same_bits(motion(samples_ * factor) / factor, expected_)) << factor;
}

TEST_P(Metamorphic, TheUnitDoesNotMatter) {
  for (const double factor : {56.4, 1e-3, -1.0})
    EXPECT_LE(change(motion(samples_ * factor) / factor, expected_), tolerance::metamorphic())
        << factor;
}

TEST_P(Metamorphic, TheOrderOfJointsDoesNotMatter) {
  EXPECT_LE(change(joints_backwards(motion(joints_backwards(samples_))), expected_),
            tolerance::metamorphic());
}

TEST_P(Metamorphic, TheTakeTwiceInABatchIsTwiceTheResult) {
  const Recording take = take_of(samples_), other = noisy_limbs(77);
  const auto together = GetParam().denoise({take, other, take});
  EXPECT_TRUE(same_bits(together[0].motion, expected_));
  EXPECT_TRUE(same_bits(together[2].motion, expected_));
  EXPECT_TRUE(same_bits(together[1].motion, GetParam().motion(other)));
}

TEST_P(Metamorphic, TimeMayRunBackwards) {
  const Matrix found = reversed_in_time(motion(reversed_in_time(samples_)));
  if (GetParam().chain == "butterworth") {
    // Its passes run forwards, then backwards: what the ends ring differs, and dies away.
    const Index middle = samples_.rows() / 3;
    EXPECT_LE(change(found.middleRows(middle, middle), expected_.middleRows(middle, middle)), 1e-5);
  } else {
    EXPECT_LE(change(found, expected_), tolerance::metamorphic());
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Metamorphic, ::testing::ValuesIn(every_cleaner()),
                         [](const auto& test) { return name_of(test.param); });

// Where the origin is does not matter to filters and auto. What is of low rank depends on it
// (docs/methods.md).
class Shifted : public Metamorphic {};

TEST_P(Shifted, TheOriginDoesNotMatter) {
  const Eigen::RowVectorXd far = Eigen::RowVectorXd::Constant(samples_.cols(), 1e4);
  const Matrix found = motion(samples_.rowwise() + far).rowwise() - far;
  EXPECT_LE(change(found, expected_), tolerance::metamorphic());
}

TEST_P(Shifted, AJointThatStandsStillHasNoSay) {
  const Matrix still = Matrix::Constant(samples_.rows(), 3, 7);
  const Matrix found = motion(beside(samples_, still));
  EXPECT_TRUE(same_bits(found.leftCols(samples_.cols()), expected_));
  EXPECT_LE(change(found.rightCols(3), still), tolerance::metamorphic());
}

INSTANTIATE_TEST_SUITE_P(Of, Shifted, ::testing::ValuesIn(cleaners_that(std::not_fn(is_low_rank))),
                         [](const auto& test) { return name_of(test.param); });

class Padded : public Metamorphic {};

TEST_P(Padded, ColumnsOfZerosHaveNoSay) {
  const Matrix found = motion(beside(samples_, Matrix::Zero(samples_.rows(), 3)));
  EXPECT_LE(change(found.leftCols(samples_.cols()), expected_), tolerance::metamorphic());
  EXPECT_TRUE(found.rightCols(3).isZero(0));
}

// The default threshold of svt and gamma of tslra depend on the number of columns.
INSTANTIATE_TEST_SUITE_P(
    Of, Padded, ::testing::ValuesIn(cleaners_that(one_of({"slra", "rpca", "tsvd", "completion"}))),
    [](const auto& test) { return name_of(test.param); });

class Repeated : public Metamorphic {};

// Twice as many frames: singular values times sqrt 2, |E|_1 times 2, lambda over sqrt 2, so that
// the minimum of |A|_* + lambda |E|_1 is the same twice, and each iteration on the way.
TEST_P(Repeated, TheTakeAfterItselfIsTheResultAfterItself) {
  Matrix twice(2 * samples_.rows(), samples_.cols());
  twice << samples_, samples_;
  const Matrix found = motion(twice);
  EXPECT_LE(change(found.topRows(samples_.rows()), expected_), tolerance::metamorphic());
  EXPECT_LE(change(found.bottomRows(samples_.rows()), expected_), tolerance::metamorphic());
}

INSTANTIATE_TEST_SUITE_P(Of, Repeated, ::testing::ValuesIn(cleaners_that(one_of({"rpca", "tsvd"}))),
                         [](const auto& test) { return name_of(test.param); });

}  // namespace
}  // namespace moclean::test
