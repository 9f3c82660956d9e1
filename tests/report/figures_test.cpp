#include "moclean/report/figures.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;
using test::tolerance::by_hand;
using testing::HasSubstr;
using testing::StartsWith;

Recording still(Index frames) {
  return {.samples = Matrix::Zero(frames, 6),
          .columns = {"Hip.x", "Hip.y", "Hip.z", "Head.x", "Head.y", "Head.z"},
          .frame_rate = 0,
          .unit = ""};
}

// Nothing moves, but for an error (3, 4, 0) of the hip in frame 0 of which (1, 0, 0) is left.
ReportTake one_error(Index frames = 3) {
  ReportTake take{.noisy = still(frames),
                  .clean = still(frames),
                  .truth = still(frames),
                  .outliers = still(frames)};
  take.noisy.samples.row(0).head(2) << 3, 4;
  take.clean.samples(0, 0) = 1;
  take.outliers.samples.row(0).head(2) << 2, 4;
  return take;
}

TEST(ReportFigures, AreThoseComputedByHand) {
  const ReportFigures found = figures(one_error());

  EXPECT_NEAR(found.rms_correction, std::sqrt(20 / 18.0), by_hand(2));
  EXPECT_EQ(found.threshold, found.rms_correction / 10);
  EXPECT_EQ(found.corrected, 2);
  EXPECT_EQ(found.corrected_frames, 1);
  EXPECT_EQ(found.observed, 18);
  EXPECT_NEAR(found.fd->noisy, 5 / std::sqrt(18.0), by_hand(2));
  EXPECT_NEAR(found.fd->clean, 1 / std::sqrt(18.0), by_hand(1));
  EXPECT_EQ(found.nearer_frames, 1);
  EXPECT_EQ(found.nearer_joints, 1);
  EXPECT_NEAR(found.roughness.noisy, 5 / std::sqrt(6.0), by_hand(3));
  EXPECT_NEAR(found.roughness.clean, 1 / std::sqrt(6.0), by_hand(1));
}

TEST(ReportFigures, CountWhatTheStatusSays) {
  ReportTake take = one_error();
  take.status = Matrix::Zero(3, 6);
  (*take.status)(0, 1) = 1;
  take.noisy.samples(2, 3) = nan;                             // filled
  take.noisy.samples(2, 4) = take.clean.samples(2, 4) = nan;  // left
  take.outliers.samples(2, 3) = take.outliers.samples(2, 4) = nan;

  const ReportFigures found = figures(take);

  EXPECT_EQ(found.threshold, 0);
  EXPECT_EQ(found.corrected, 1);
  EXPECT_EQ(found.corrected_frames, 1);
  EXPECT_EQ(found.filled, 1);
  EXPECT_EQ(found.left, 1);
}

TEST(ReportFigures, OpenWhereMostWasGained) {
  ReportTake take = one_error(60);
  take.noisy.samples(20, 3) = take.clean.samples(20, 3) = 30;  // worse, but as bad as before
  take.noisy.samples(40, 4) = take.outliers.samples(40, 4) = 7;

  EXPECT_EQ(figures(take).opening.frame, 40);
  EXPECT_EQ(figures(take).opening.joint, 1);
  take.truth.reset();
  EXPECT_EQ(figures(take).opening.frame, 40) << "where most was taken away";
  take.outliers.samples.setZero();
  EXPECT_EQ(figures(take).opening.frame, -1);
}

TEST(ReportFigures, NameWhereItWasBad) {
  const ReportFigures found = figures(one_error());

  ASSERT_EQ(found.joints.size(), 2);
  EXPECT_EQ(found.joints[0].name, "Hip");
  EXPECT_NEAR(found.joints[0].correction, std::sqrt(20 / 9.0), by_hand(2));
  EXPECT_NEAR(found.joints[0].error->noisy, 5 / 3.0, by_hand(2));
  EXPECT_NEAR(found.joints[0].error->clean, 1 / 3.0, by_hand(1));
  EXPECT_EQ(found.joints[1].correction, 0);
  ASSERT_EQ(found.worst_frames.size(), 1);
  EXPECT_EQ(found.worst_frames[0].frame, 0);
  EXPECT_EQ(found.worst_frames[0].joint, 0);
  EXPECT_NEAR(found.worst_frames[0].correction, std::sqrt(20.0), by_hand(5));
  EXPECT_NEAR(found.per_frame(0, 0), std::sqrt(20 / 6.0), by_hand(2));
  EXPECT_NEAR(found.per_frame(0, 1), 5 / std::sqrt(6.0), by_hand(3));
  EXPECT_NEAR(found.per_frame(0, 2), 1 / std::sqrt(6.0), by_hand(1));
  EXPECT_EQ(found.per_frame.bottomRows(2), Matrix::Zero(2, 3));
}

TEST(ReportFigures, KeepWorstFramesApart) {
  ReportTake take = one_error(60);
  take.noisy.samples(9, 4) = 4;    // beside frame 0, which is worse
  take.noisy.samples(10, 3) = 2;   // ten frames from it
  take.noisy.samples(40, 3) = 30;  // the worst of all
  take.outliers.samples(40, 3) = 30;

  const ReportFigures found = figures(take);

  ASSERT_EQ(found.worst_frames.size(), 3);
  EXPECT_EQ(found.worst_frames[0].frame, 40);
  EXPECT_EQ(found.worst_frames[0].joint, 1);
  EXPECT_EQ(found.worst_frames[1].frame, 0);
  EXPECT_EQ(found.worst_frames[2].frame, 10);
}

TEST(ReportFigures, CountAFrameThatCleaningSpoilt) {
  ReportTake take = one_error(60);
  take.clean.samples(30, 4) = 7;
  take.outliers.samples(30, 4) = -7;

  const ReportFigures found = figures(take);

  ASSERT_EQ(found.worst_frames.size(), 2);
  EXPECT_EQ(found.worst_frames[0].frame, 30);
  EXPECT_EQ(found.worst_frames[0].joint, 1);
}

TEST(ReportFigures, LeaveGapsOut) {
  ReportTake take = one_error();
  for (Recording* clip : {&take.noisy, &take.clean, &take.outliers}) {
    clip->samples.row(1).setConstant(nan);
    clip->samples(2, 5) = nan;
  }

  const ReportFigures found = figures(take);
  const Matrix corrections = joint_corrections(take.outliers);

  EXPECT_EQ(found.observed, 11);
  EXPECT_NEAR(found.fd->noisy, 5 / std::sqrt(11.0), by_hand(2));
  EXPECT_EQ(found.roughness.noisy, 0);  // no three frames in a row
  EXPECT_TRUE(std::isnan(found.per_frame(1, 0)));
  EXPECT_TRUE(std::isnan(corrections(1, 0)));
  EXPECT_EQ(corrections(2, 1), 0);
}

TEST(ReportFigures, RejectPartsOfAnotherShape) {
  ReportTake take = one_error();
  take.truth = still(4);

  EXPECT_THAT([&] { figures(take); },
              testing::ThrowsMessage<ShapeError>(HasSubstr("the truth of a report is 4 frames")));
}

TEST(Verdict, SaysWhetherTheTakeGotBetter) {
  ReportTake take = one_error();
  EXPECT_EQ(verdict(take, figures(take)), "The take got better: 5.0 times nearer to the truth.");

  std::swap(take.noisy, take.clean);
  EXPECT_EQ(verdict(take, figures(take)), "The take got worse: 5.00 times as far from the truth.");

  take.noisy = *take.truth;
  EXPECT_EQ(verdict(take, figures(take)), "The take got worse: it was the truth before cleaning.");

  take.clean = *take.truth;
  EXPECT_EQ(verdict(take, figures(take)), "The take is as far from the truth as before.");
}

TEST(Verdict, ClaimsNothingWithoutATruth) {
  ReportTake take = one_error();
  take.truth.reset();

  EXPECT_THAT(verdict(take, figures(take)),
              StartsWith("11.1 % of the entries were corrected; from frame to frame the take is "
                         "5.0 times smoother. Only a truth"));
}

}  // namespace
}  // namespace moclean
