#include "cli/printing/progress_line.hpp"

#include <gtest/gtest.h>

namespace moclean::cli {
namespace {

TEST(ProgressText, StatesRateAndTimeLeft) {
  EXPECT_EQ(progress_text("solving", {.finished = 20, .total = 140}, 2.5),
            "solving: 20 of 140 segments, 8.0 segments/s, 15 s left");
}

TEST(ProgressText, PromisesNothingBeforeTheFirstSegment) {
  EXPECT_EQ(progress_text("solving", {.finished = 0, .total = 140}, 2.5),
            "solving: 0 of 140 segments");
}

TEST(ProgressText, MeasuresFromTheFirstFinishedSegmentsOnAndNotByOne) {
  EXPECT_EQ(progress_text("solving", {.finished = 28, .total = 140}, 2, ProgressTotal::exact,
                          "segments", 8),
            "solving: 28 of 140 segments, 10.0 segments/s, 12 s left");
  EXPECT_EQ(progress_text("solving", {.finished = 9, .total = 140}, 2, ProgressTotal::exact,
                          "segments", 8),
            "solving: 9 of 140 segments");
}

TEST(ProgressText, SaysWhereTheTotalIsAnEstimate) {
  EXPECT_EQ(progress_text("solving", {.finished = 0, .total = 140}, 0, ProgressTotal::estimated),
            "solving: 0 of about 140 segments");
}

TEST(ProgressText, IsTheTaskAloneWithoutATotal) {
  EXPECT_EQ(progress_text("solving", {}, 2.5), "solving");
}

}  // namespace
}  // namespace moclean::cli
