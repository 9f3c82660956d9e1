// Takes at the ends of what a take can be: an answer from every step, or an error that says which
// take; never NaN where there was a sample, nor a number out of nothing.

#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "contract/cleaner.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean::test {
namespace {

struct Degenerate {
  const char* name;
  Matrix samples;
  bool too_small = false;  // for steps of low rank, which square it
  bool rough = false;      // a frame tells nothing of the next
};

Matrix limbs(Index frames = 60, Index joint_count = 3) {
  return swinging_limbs(frames, joint_count);
}

// limbs() with something done to them.
Matrix with(const std::function<void(Matrix&)>& change, Matrix samples = limbs()) {
  change(samples);
  return samples;
}

std::vector<Degenerate> degenerates() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const Matrix steps = with([](Matrix& m) { m.bottomRows(30).array() += 100; });
  return {
      {"Zeros", Matrix::Zero(60, 9)},
      {"Ones", Matrix::Ones(60, 9)},
      {"MinusZeros", -Matrix::Zero(60, 9)},
      {"Constants", limbs().row(7).replicate(60, 1)},
      {"OneFrame", limbs(1)},
      {"TwoFrames", limbs(2)},
      {"ThreeFrames", limbs(3)},
      {"FourFrames", limbs(4)},
      {"OneColumn", limbs().leftCols(1)},
      {"TwoColumns", limbs().leftCols(2)},
      {"OneSample", Matrix::Constant(1, 1, 3)},
      {"OneFrameOfManyColumns", limbs(1, 100)},
      {"MoreColumnsThanFrames", limbs(10, 20)},
      {"OneSpike", with([](Matrix& m) { m.setZero(), m(30, 4) = 50; })},
      {"SpikeAtTheEnds", with([](Matrix& m) { m(0, 0) = m(59, 8) = 1e6; })},
      {"OneStep", steps},
      {"Alternating", with([](Matrix& m) {
         for (Index t = 0; t < 60; ++t) m.row(t).setConstant(t % 2 == 0 ? 1 : -1);
       }),
       false, true},
      {"AlternatingFrames", with([](Matrix& m) {
         for (Index t = 0; t < 60; t += 2) m.row(t) *= -1;
       }),
       false, true},
      {"TwoEqualColumns", with([](Matrix& m) { m.col(3) = m.col(0); })},
      {"AllColumnsEqual", limbs().col(0).replicate(1, 9)},
      {"AJointTwice", with([](Matrix& m) { m.rightCols(3) = m.leftCols(3); })},
      {"ALine", with([](Matrix& m) {
         for (Index t = 0; t < 60; ++t) m.row(t).setConstant(static_cast<double>(t));
       })},
      {"RoundedToWholeNumbers", limbs().array().round()},
      {"Tiny", limbs() * 1e-120},
      {"TooTinyToSquare", limbs() * 1e-300, true},
      {"Denormal", limbs() * 1e-310, true},
      {"Huge", limbs() * 1e130},
      {"TinyBesideHuge", with([](Matrix& m) { m.leftCols(3) *= 1e-100, m.rightCols(3) *= 1e100; })},
      {"FarAway", limbs().array() + 1e12},
      {"NoiseAlone", random_matrix(60, 9, 3), false, true},
      {"HalfStill", with([](Matrix& m) {
         for (Index t = 0; t < 30; ++t) m.row(t) = m.row(30);
       })},
      {"MissingEverywhere", Matrix::Constant(60, 9, nan)},
      {"MissingButOneSample", with([](Matrix& m) { m.setConstant(nan), m(30, 4) = 5; })},
      {"MissingButTheFirstFrame", with([](Matrix& m) { m.bottomRows(59).setConstant(nan); })},
      {"MissingColumn", with([](Matrix& m) { m.col(4).setConstant(nan); })},
      {"MissingJoint", with([](Matrix& m) { m.leftCols(3).setConstant(nan); })},
      {"MissingFrames", with([](Matrix& m) { m.middleRows(20, 20).setConstant(nan); })},
      {"MissingEndFrames",
       with([](Matrix& m) { m.topRows(9).setConstant(nan), m.bottomRows(9).setConstant(nan); })},
      {"MissingEveryOther", with([](Matrix& m) {
         for (Index i = 0; i < m.size(); i += 2) m.data()[i] = nan;
       })},
      {"Infinite", with([](Matrix& m) { m(8, 2) = inf; })},
  };
}

// Why a step may refuse a take: a part of the message, or nothing.
std::string refusal(const Cleaner& cleaner, const Degenerate& take) {
  if (take.samples.array().isInf().any()) return "infinite at frame 8, column joint0.z";
  if (take.samples.array().isNaN().any() && !accepts_missing(parse_chain(cleaner.chain)))
    return "missing samples are not supported";
  if (take.too_small && is_low_rank(cleaner)) return "has no sample larger than";
  if (take.rough && cleaner.chain == "auto") return "its rows are not smooth in time";
  // Its rule is one of random matrices.
  if (cleaner.chain == "svt" && std::min(take.samples.rows(), take.samples.cols()) < 3)
    return "svt has no rule";
  return "";
}

class DegenerateTakes : public ::testing::TestWithParam<Cleaner> {};

TEST_P(DegenerateTakes, AreAnsweredOrRefusedWithTheReason) {
  for (const Degenerate& take : degenerates()) {
    SCOPED_TRACE(take.name);
    const std::string reason = refusal(GetParam(), take);
    Denoised result;
    try {
      result = GetParam().denoise({take_of(take.samples)}).at(0);
    } catch (const Error& error) {
      EXPECT_FALSE(reason.empty()) << error.what();
      EXPECT_THAT(error.what(), ::testing::HasSubstr(reason));
      continue;
    }
    EXPECT_EQ(reason, "");
    ASSERT_EQ(result.motion.rows(), take.samples.rows());
    ASSERT_EQ(result.motion.cols(), take.samples.cols());
    double size = 0, farthest = 0;
    for (Index i = 0; i < take.samples.size(); ++i) {
      const double y = take.samples.data()[i], z = result.motion.data()[i];
      EXPECT_TRUE(std::isnan(y) || std::isfinite(z)) << "sample " << i << ": " << y << " -> " << z;
      EXPECT_FALSE(std::isinf(z)) << "sample " << i;
      if (std::isfinite(y)) size = std::max(size, std::abs(y));
      if (std::isfinite(z)) farthest = std::max(farthest, std::abs(z));
    }
    // Lines are continued; what swings from frame to frame rings.
    EXPECT_LE(farthest, 3 * size);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, DegenerateTakes, ::testing::ValuesIn(every_cleaner()),
                         [](const auto& test) { return name_of(test.param); });

class ConstantTakes : public ::testing::TestWithParam<Cleaner> {};

TEST_P(ConstantTakes, StayAsTheyAre) {
  for (const Matrix& constant : {Matrix(Matrix::Zero(40, 6)), Matrix(Matrix::Constant(40, 6, 7)),
                                 Matrix(limbs().row(7).replicate(40, 1))}) {
    const Matrix found = GetParam().motion(take_of(constant));
    EXPECT_LE(largest_difference(found, constant), 1e-12 * constant.cwiseAbs().maxCoeff());
  }
}

// svt shrinks what it keeps, completion and tslra stop at their tolerance.
INSTANTIATE_TEST_SUITE_P(
    Of, ConstantTakes,
    ::testing::ValuesIn(cleaners_that(std::not_fn(one_of({"svt", "completion", "tslra"})))),
    [](const auto& test) { return name_of(test.param); });

}  // namespace
}  // namespace moclean::test
