#include "moclean/segment/spans.hpp"

#include <cmath>
#include <numeric>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::ThrowsMessage;

// A batch whose segments are the spans of `take`.
SegmentBatch stacked(const Matrix& take, const Spans& spans) {
  std::vector<Index> first_row = {0};
  for (const Span& span : spans) first_row.push_back(first_row.back() + span.frames());
  SegmentBatch batch(take.cols(), first_row);
  stack_spans(take, spans, batch);
  return batch;
}

TEST(OverlappingSpans, AreTheSegmentsWithoutOverlap) {
  EXPECT_THAT(overlapping_spans({0, 3, 6, 10}, 0),
              ElementsAre(Span{0, 3}, Span{3, 6}, Span{6, 10}));
}

TEST(OverlappingSpans, ShareFramesAroundTheBoundary) {
  EXPECT_THAT(overlapping_spans({0, 10, 20, 30}, 4),
              ElementsAre(Span{0, 12}, Span{8, 22}, Span{18, 30}));
  EXPECT_THAT(overlapping_spans({0, 10, 20}, 3), ElementsAre(Span{0, 12}, Span{9, 20}));
  EXPECT_THAT(overlapping_spans({0, 10, 20}, 1), ElementsAre(Span{0, 11}, Span{10, 20}));
}

TEST(OverlappingSpans, ShareNoMoreThanTheShorterNeighbourHas) {
  EXPECT_THAT(overlapping_spans({0, 10, 13, 30}, 8),
              ElementsAre(Span{0, 12}, Span{9, 15}, Span{12, 30}));
  EXPECT_THAT(overlapping_spans({0, 5}, 100), ElementsAre(Span{0, 5}));
}

TEST(OverlappingSpans, RefuseANegativeOverlap) {
  EXPECT_THAT(
      [] {
        overlapping_spans({0, 5}, -1);
      },
      ThrowsMessage<ArgumentError>("overlap is -1, expected at least 0"));
}

TEST(OverlappingSpans, CoverEveryFrameOnceOrTwice) {
  for (Index frames = 1; frames <= 60; ++frames)
    for (Index length = 1; length <= 20; ++length)
      for (const Index overlap : {0, 1, 2, 5, 6, 1000}) {
        const Spans spans = overlapping_spans(segments_of_length(frames, length), overlap);

        std::vector<int> covered(static_cast<std::size_t>(frames), 0);
        for (const Span& span : spans)
          for (Index f = span.first; f < span.last; ++f) ++covered.at(static_cast<std::size_t>(f));
        const auto [least, most] = std::ranges::minmax(covered);
        ASSERT_GE(least, 1) << frames << " " << length << " " << overlap;
        ASSERT_LE(most, 2) << frames << " " << length << " " << overlap;
        for (std::size_t s = 1; s < spans.size(); ++s) {
          ASSERT_GT(spans[s].first, spans[s - 1].first);
          ASSERT_GE(spans[s].last, spans[s - 1].last);
        }
      }
}

TEST(BlendWeight, IsARaisedCosine) {
  EXPECT_NEAR(blend_weight(0, 1), 0.5, test::tolerance::by_hand(1));
  EXPECT_NEAR(blend_weight(0, 2), 0.25, test::tolerance::by_hand(1));  // (1 - cos 60) / 2
  EXPECT_NEAR(blend_weight(1, 2), 0.75, test::tolerance::by_hand(1));
}

TEST(BlendWeights, SumToOneAtEveryFrame) {
  for (const Index overlap : {0, 1, 4, 7, 10, 50}) {
    const Spans spans = overlapping_spans({0, 10, 20, 33, 40}, overlap);

    std::vector<double> sum(40, 0.0);
    for (std::size_t s = 0; s < spans.size(); ++s) {
      const std::vector<double> weights = blend_weights(spans, s);
      ASSERT_EQ(static_cast<Index>(weights.size()), spans[s].frames());
      for (std::size_t k = 0; k < weights.size(); ++k) {
        EXPECT_GT(weights[k], 0);
        sum[static_cast<std::size_t>(spans[s].first) + k] += weights[k];
      }
    }
    for (const double w : sum) EXPECT_NEAR(w, 1, test::tolerance::by_hand(1)) << overlap;
  }
}

TEST(BlendSpans, GivesBackWhatWasStacked) {
  Matrix take(40, 3);
  for (Index f = 0; f < 40; ++f) take.row(f) << 0.1, std::sin(0.3 * double(f)), double(f) / 7;
  for (const Index overlap : {0, 3, 10}) {
    const Spans spans = overlapping_spans({0, 10, 20, 33, 40}, overlap);

    EXPECT_TRUE(test::same_bits(blend_spans(stacked(take, spans), spans), take)) << overlap;
  }
}

TEST(BlendSpans, WeighsTheSegmentsAsTheWeightsSay) {
  const Spans spans = overlapping_spans({0, 10, 20, 33, 40}, 6);
  SegmentBatch batch = stacked(Matrix::Zero(40, 2), spans);
  for (Index s = 0; s < 4; ++s) batch.segment(s).setConstant(double(s + 1));

  const Matrix take = blend_spans(batch, spans);

  Matrix expected = Matrix::Zero(40, 2);
  for (std::size_t s = 0; s < 4; ++s) {
    const std::vector<double> weights = blend_weights(spans, s);
    for (std::size_t k = 0; k < weights.size(); ++k)
      expected.row(spans[s].first + static_cast<Index>(k)).array() += double(s + 1) * weights[k];
  }
  EXPECT_LE((take - expected).cwiseAbs().maxCoeff(), test::tolerance::by_hand(4));
}

TEST(BlendSpans, LeavesNoStepBetweenSegmentsThatAreApart) {
  constexpr Index overlap = 20;
  const Spans spans = overlapping_spans({0, 40, 80}, overlap);
  SegmentBatch batch = stacked(Matrix::Zero(80, 1), spans);
  batch.segment(1).setOnes();

  const Matrix take = blend_spans(batch, spans);

  const Matrix second = take.topRows(78) - 2 * take.middleRows(1, 78) + take.bottomRows(78);
  const double bound = std::pow(std::acos(-1.0) / overlap, 2) / 2;
  EXPECT_LE(second.cwiseAbs().maxCoeff(), bound);
  EXPECT_GE(second.cwiseAbs().maxCoeff(), bound / 2);
}

TEST(BlendSpans, KeepsNaN) {
  const Spans spans = overlapping_spans({0, 10, 20}, 4);
  Matrix take = Matrix::Ones(20, 2);
  take(9, 1) = take(15, 0) = test::nan;

  const Matrix blended = blend_spans(stacked(take, spans), spans);

  EXPECT_TRUE((blended.array().isNaN() == take.array().isNaN()).all());
}

TEST(BlendSpans, TakesOneOfSeveralTakesOutOfABatch) {
  const Spans spans = overlapping_spans({0, 2, 4}, 2);
  SegmentBatch batch(1, {0, 5, 8, 11});
  batch.segment(0).setConstant(9);
  Matrix take(4, 1);
  take << 1, 2, 3, 4;

  stack_spans(take, spans, batch, 1);

  EXPECT_TRUE(test::same_bits(blend_spans(batch, spans, 1), take));
  EXPECT_EQ(batch.segment(0).minCoeff(), 9);
}

TEST(StackSpans, RefuseABatchOfOtherSegments) {
  const Spans spans = overlapping_spans({0, 2, 4}, 0);
  SegmentBatch longer(1, {0, 2, 5}), fewer(1, {0, 2}), wider(2, {0, 2, 4});
  const Matrix take = Matrix::Ones(4, 1);

  EXPECT_THAT([&] { stack_spans(take, spans, longer); },
              ThrowsMessage<ShapeError>("segment 1 of a batch has 3 frames, its span 2"));
  EXPECT_THAT([&] { stack_spans(take, spans, fewer); },
              ThrowsMessage<ShapeError>("segments 0 to 2 of a batch of 1"));
  EXPECT_THAT([&] { stack_spans(take, spans, wider); },
              ThrowsMessage<ShapeError>("a take of 1 columns does not fit a batch of 2"));
  EXPECT_THAT([&] { stack_spans(Matrix::Ones(5, 1), spans, longer); },
              ThrowsMessage<ShapeError>("segment 1 of a batch has 3 frames, its span 2"));
  EXPECT_THROW(blend_spans(fewer, spans), ShapeError);
}

}  // namespace
}  // namespace moclean
