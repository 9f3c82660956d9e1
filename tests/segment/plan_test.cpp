#include "moclean/segment/plan.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(EqualSegments, DividesAsOnPaper) {
  EXPECT_THAT(equal_segments(10, 3), ElementsAre(0, 3, 6, 10));
  EXPECT_THAT(equal_segments(7, 4), ElementsAre(0, 1, 3, 5, 7));
  EXPECT_THAT(equal_segments(5, 1), ElementsAre(0, 5));
  EXPECT_THAT(equal_segments(1, 1), ElementsAre(0, 1));
}

TEST(EqualSegments, GivesOneSegmentPerFrameAtMost) {
  EXPECT_THAT(equal_segments(3, 100), ElementsAre(0, 1, 2, 3));
}

TEST(EqualSegments, CoversEveryFrameOnceInSizesThatDifferByAtMostOne) {
  for (Index frames = 1; frames <= 130; ++frames)
    for (Index segments = 1; segments <= frames; ++segments) {
      const SegmentPlan plan = equal_segments(frames, segments);

      ASSERT_EQ(plan.size(), static_cast<std::size_t>(segments) + 1);
      for (Index s = 0; s <= segments; ++s)
        ASSERT_EQ(plan[static_cast<std::size_t>(s)], frames * s / segments)
            << frames << " frames, " << segments << " segments";
      for (std::size_t s = 1; s < plan.size(); ++s) {
        ASSERT_GE(plan[s] - plan[s - 1], frames / segments);
        ASSERT_LE(plan[s] - plan[s - 1], (frames + segments - 1) / segments);
      }
    }
}

TEST(EqualSegments, DoesNotOverflowForTheLongestTake) {
  const Index frames = std::numeric_limits<Index>::max();  // 3 * 3074457345618258602 + 1

  const SegmentPlan plan = equal_segments(frames, 3);

  EXPECT_THAT(plan, ElementsAre(0, 3074457345618258602, 6148914691236517204, frames));
}

TEST(EqualSegments, RefusesNoSegmentsAndNoFrames) {
  EXPECT_THAT([] { equal_segments(10, 0); },
              ThrowsMessage<ArgumentError>("number of segments is 0, expected at least 1"));
  EXPECT_THAT([] { equal_segments(0, 1); },
              ThrowsMessage<ArgumentError>("number of frames is 0, expected at least 1"));
}

TEST(SegmentsOfLength, DividesThePapersTakes) {
  EXPECT_EQ(segments_of_length(1200, 200).size(), 6u + 1);
  EXPECT_EQ(segments_of_length(2000, 400).size(), 5u + 1);
  EXPECT_EQ(segments_of_length(2800, 400).size(), 7u + 1);
}

TEST(SegmentsOfLength, RoundsTheNumberOfSegmentsToTheNearest) {
  EXPECT_THAT(segments_of_length(449, 200), ElementsAre(0, 224, 449));       // 2.245
  EXPECT_THAT(segments_of_length(500, 200), ElementsAre(0, 166, 333, 500));  // 2.5: up
  EXPECT_THAT(segments_of_length(7, 3), ElementsAre(0, 3, 7));               // 2.33
  EXPECT_THAT(segments_of_length(8, 3), ElementsAre(0, 2, 5, 8));            // 2.67
  EXPECT_THAT(segments_of_length(5, std::numeric_limits<Index>::max()), ElementsAre(0, 5));
}

TEST(SegmentsOfLength, LeavesNoShortTail) {
  EXPECT_THAT(segments_of_length(402, 200), ElementsAre(0, 201, 402));
}

TEST(SegmentsOfLength, KeepsATakeShorterThanOneSegmentWhole) {
  EXPECT_THAT(segments_of_length(99, 200), ElementsAre(0, 99));
  EXPECT_THAT(segments_of_length(100, 200), ElementsAre(0, 100));
  EXPECT_THAT(segments_of_length(1, 200), ElementsAre(0, 1));
}

TEST(SegmentsOfLength, FollowsTheFormulaForEverySmallPair) {
  for (Index frames = 1; frames <= 200; ++frames)
    for (Index length = 1; length <= 200; ++length) {
      const auto ratio = static_cast<double>(frames) / static_cast<double>(length);
      const Index expected = std::max<Index>(1, static_cast<Index>(std::floor(ratio + 0.5)));

      ASSERT_EQ(segments_of_length(frames, length), equal_segments(frames, expected))
          << frames << " frames, length " << length;
    }
}

TEST(SegmentsOfLength, RefusesALengthBelowOne) {
  EXPECT_THAT([] { segments_of_length(10, 0); },
              ThrowsMessage<ArgumentError>(HasSubstr("segment length is 0, expected at least 1")));
}

}  // namespace
}  // namespace moclean
