#include "moclean/denoise/moving_part.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::nan;
using testing::ElementsAre;

// A joint that moves, one that does not, and a column of each kind.
Recording small_take() {
  Recording take{.samples = Matrix(3, 8),
                 .columns = {"a.x", "a.y", "a.z", "b.x", "b.y", "b.z", "time", "weight"},
                 .frame_rate = 60,
                 .unit = "mm"};
  take.samples << 1, 7, 2, 0, 0, 0, 10, 70,  //
      2, 7, nan, 0, 0, 0, 20, 70,            //
      4, 7, 5, 0, nan, 0, 30, nan;
  return take;
}

// What a method might say of the part.
Denoised result_for(const MovingPart& part, const Matrix& motion) {
  return {.motion = motion,
          .outliers = {},
          .sigma = Matrix::Constant(motion.rows(), motion.cols(), 0.5),
          .trusted = !part.clip.samples.array().isNaN()};
}

TEST(MovingPart, LeavesOutWhatStandsStillAndCentresTheRest) {
  const MovingPart part = moving_part(small_take(), true);

  EXPECT_THAT(part.columns, ElementsAre(0, 1, 2, 6));
  EXPECT_THAT(part.clip.columns, ElementsAre("a.x", "a.y", "a.z", "time"));
  EXPECT_THAT(part.still, ElementsAre(false, true, false, true, true, true, false, true));
  EXPECT_THAT(part.medians, ElementsAre(2, 7, 3.5, 0, 0, 0, 20, 70));
  EXPECT_THAT(part.centre, ElementsAre(2, 7, 3.5, 2, 7, 3.5, 20, 70));
  EXPECT_THAT(part.clip.samples.row(0), ElementsAre(-1, 0, -1.5, -10));
  EXPECT_TRUE(std::isnan(part.clip.samples(1, 2)));
  EXPECT_EQ(part.clip.frame_rate, 60);
}

TEST(MovingPart, KeepsDistancesOfJoints) {
  Recording take = small_take();
  take.samples.block(0, 3, 3, 3) << 5, 5, 5, 6, 5, 5, 8, 6, 5;

  const MovingPart part = moving_part(take, true);

  EXPECT_THAT(part.centre.head(3), ElementsAre((2 + 6) / 2., (7 + 5) / 2., (3.5 + 5) / 2));
  const Matrix apart = part.clip.samples.middleCols(0, 3) - part.clip.samples.middleCols(3, 3);
  EXPECT_THAT(apart.row(0), ElementsAre(1 - 5, 7 - 5, 2 - 5));
}

TEST(MovingPart, TakesZerosForLostOnlyWhereItIsTold) {
  Recording take = small_take();
  take.samples = Matrix(5, 8);
  for (Index i = 0; i < 5; ++i)
    take.samples.row(i) << 5, 5, 5 + 0.1 * static_cast<double>(i), 0, 0, 0, 1, 1;
  take.samples.row(2).head(3).setZero();

  EXPECT_TRUE(moving_part(take, true).clip.samples.row(2).head(3).array().isNaN().all());
  EXPECT_FALSE(moving_part(take, false).clip.samples.array().isNaN().any());
}

TEST(MovingPart, TakesZerosOfPointsOfAPictureForLost) {
  Recording take{Matrix(5, 4), {"a.x", "a.y", "b.x", "b.y"}, 60, "px"};
  for (Index i = 0; i < 5; ++i)
    take.samples.row(i) << 500 + static_cast<double>(i), 300, 0, 200 + 2 * static_cast<double>(i);
  take.samples.row(2).head(2).setZero();

  const Matrix samples = moving_part(take, true).clip.samples;

  EXPECT_TRUE(samples.row(2).head(2).array().isNaN().all());
  EXPECT_EQ(samples.array().isNaN().count(), 2) << "a coordinate of 0 is none";
}

TEST(PutBack, KeepsUnchangedSamplesToTheLastBitAndStillColumns) {
  Recording take = small_take();
  take.samples.col(0) << 0.1, 0.7, 1e4 / 3;  // minus 0.7 and plus 0.7 are not the same again
  const MovingPart part = moving_part(take, true);
  Matrix motion = part.clip.samples;
  motion(1, 0) += 0.25;
  motion(1, 2) = 0.5;  // was missing
  Denoised result = result_for(part, motion);
  (*result.trusted)(1, 0) = false;

  put_back(take, part, result);

  EXPECT_TRUE(result.motion(0, 0) == 0.1 && result.motion(2, 0) == 1e4 / 3);
  EXPECT_EQ(result.motion(1, 0), 0.25 + 0.7);
  EXPECT_EQ(result.outliers(1, 0), 0.7 - (0.25 + 0.7));
  EXPECT_EQ(result.outliers.cwiseAbs().sum(), std::abs(result.outliers(1, 0)));
  EXPECT_EQ(result.motion(1, 2), 4);
  EXPECT_TRUE((result.motion.col(7).array() == 70).all());
  EXPECT_TRUE((result.motion.middleCols(3, 3).array() == 0).all());
  EXPECT_FALSE((*result.trusted)(1, 0) || (*result.trusted)(2, 4) || (*result.trusted)(2, 7));
  EXPECT_TRUE((*result.trusted)(0, 4) && (*result.trusted)(0, 7));
  EXPECT_EQ((*result.sigma)(0, 7), 0);
  EXPECT_TRUE(std::isnan((*result.sigma)(2, 7)));
  EXPECT_EQ((*result.sigma)(0, 6), 0.5);
}

}  // namespace
}  // namespace moclean
