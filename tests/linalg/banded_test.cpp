#include "moclean/linalg/banded.hpp"

#include <tuple>

#include <gmock/gmock.h>

#include "moclean/core/band_matrix.hpp"
#include "moclean/core/error.hpp"

#include "support/band_systems.hpp"
#include "support/device.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

// Segments of random numbers, padding zero.
SegmentBatch random_batch(Index columns, const std::vector<Index>& rows, std::uint64_t seed) {
  std::vector<Matrix> segments;
  for (const Index count : rows) segments.push_back(test::random_matrix(count, columns, seed++));
  return test::batch_of(segments);
}

// Weights of 0.1 to 1 in the columns, zero in the padding.
SegmentBatch weights_like(const SegmentBatch& shape) {
  SegmentBatch weights(shape.columns(), shape.first_rows());
  Random random(5);
  auto all = weights.block(0, weights.rows());
  for (Index i = 0; i < all.rows(); ++i)
    for (Index j = 0; j < all.cols(); ++j) all(i, j) = 0.1 + 0.9 * random.uniform();
  return weights;
}

// q of every column and segment: `gamma` times 1 to 2, zero in the padding.
std::vector<double> column_penalties(const SegmentBatch& shape, double gamma) {
  std::vector<double> q;
  for (Index b = 0; b < shape.segments(); ++b)
    for (Index j = 0; j < shape.pitch(); ++j)
      q.push_back(j < shape.columns() ? gamma * (1 + double(j) / double(shape.columns())) : 0);
  return q;
}

SegmentBatch solve_columns(int width, const SegmentBatch& b, const SegmentBatch& weights,
                           const std::vector<double>& q) {
  const Device& device = test::device();
  const Batch batch(device, b, 0, b.segments());
  Banded<double> banded(device, width);
  MemoryLayout layout(test::device(), batch);
  ColumnBands<double> bands = banded.column_bands(layout);
  Buffer<double> x(device, b.storage());  // solved in place
  const Buffer<double> w(device, weights.storage()), penalties(device, std::span(q));

  banded.assemble(batch, w, penalties, bands);
  banded.factor(batch, bands);
  banded.solve(batch, bands, x, x);

  SegmentBatch result(b.columns(), b.first_rows());
  x.read(result.storage());
  return result;
}

SegmentBatch solve_shared(int width, const SegmentBatch& b, const std::vector<double>& c,
                          const std::vector<double>& q) {
  const Device& device = test::device();
  const Batch batch(device, b, 0, b.segments());
  Banded<double> banded(device, width);
  MemoryLayout layout(test::device(), batch);
  SharedBands<double> bands = banded.shared_bands(layout);
  const Buffer<double> right(device, b.storage()), weights(device, std::span(c)),
      penalties(device, std::span(q));
  Buffer<double> x(device, b.storage().size());

  banded.factor(batch, weights, penalties, bands);
  banded.solve(batch, bands, right, x);

  SegmentBatch result(b.columns(), b.first_rows());
  x.read(result.storage());
  return result;
}

double padding_of(const SegmentBatch& batch) {
  const Eigen::Map<const Matrix> rows(batch.storage().data(), batch.rows(), batch.pitch());
  return rows.rightCols(batch.pitch() - batch.columns()).cwiseAbs().sum();
}

const std::vector<Index> lengths = {1, 2, 3, 4, 5, 7, 300};

class BandedTest : public testing::TestWithParam<std::tuple<int, Index, double>> {
 protected:
  int width() const { return std::get<0>(GetParam()); }
  Index columns() const { return std::get<1>(GetParam()); }
  double gamma() const { return std::get<2>(GetParam()); }
};

TEST_P(BandedTest, SolvesEveryColumnWithASmallBackwardError) {
  const SegmentBatch b = random_batch(columns(), lengths, 1), w = weights_like(b);
  const std::vector<double> q = column_penalties(b, gamma());

  const SegmentBatch x = solve_columns(width(), b, w, q);

  for (Index s = 0; s < b.segments(); ++s)
    for (Index j = 0; j < columns(); ++j) {
      const test::BandSystem system{w.segment(s).col(j), b.segment(s).col(j),
                                    q[static_cast<std::size_t>(s * b.pitch() + j)], width()};
      EXPECT_LE(test::backward_error(system, x.segment(s).col(j)),
                test::tolerance::band_backward_error(width()))
          << "segment " << s << ", column " << j;
    }
  EXPECT_EQ(padding_of(x), 0);
}

TEST_P(BandedTest, SolvesByASharedFactorWithASmallBackwardError) {
  const SegmentBatch b = random_batch(columns(), lengths, 1);
  std::vector<double> c, q;
  for (std::size_t s = 0; s < lengths.size(); ++s) {
    c.push_back(0.5 + double(s));
    q.push_back(gamma() * (1 + double(s)));
  }

  const SegmentBatch x = solve_shared(width(), b, c, q);

  for (Index s = 0; s < b.segments(); ++s)
    for (Index j = 0; j < columns(); ++j) {
      const auto i = static_cast<std::size_t>(s);
      const test::BandSystem system{Eigen::VectorXd::Constant(b.rows(s), c[i]), b.segment(s).col(j),
                                    q[i], width()};
      EXPECT_LE(test::backward_error(system, x.segment(s).col(j)),
                test::tolerance::band_backward_error(width()))
          << "segment " << s << ", column " << j;
    }
  EXPECT_EQ(padding_of(x), 0);
}

std::string name_of_banded(const testing::TestParamInfo<BandedTest::ParamType>& parameter) {
  const auto& [width, columns, gamma] = parameter.param;
  const std::string size = gamma < 1 ? "Small" : gamma > 1 ? "Large" : "One";
  return "Width" + std::to_string(width) + "Columns" + std::to_string(columns) + "Gamma" + size;
}

INSTANTIATE_TEST_SUITE_P(Shapes, BandedTest,
                         testing::Combine(testing::Values(1, 2, 3),
                                          testing::Values<Index>(1, 8, 17, 93),
                                          testing::Values(1e-6, 1.0, 1e8)),
                         name_of_banded);

class BandedWidth : public testing::TestWithParam<int> {};

TEST_P(BandedWidth, PenaltyIsThatOfTheReference) {
  const SegmentBatch x = random_batch(21, {1, 2, 3, 4, 5, 8, 600}, 3);
  const Device& device = test::device();
  const Batch batch(device, x, 0, x.segments());
  const Buffer<double> source(device, x.storage());
  Buffer<double> target(device, x.storage().size());

  Banded<double>(device, GetParam()).penalise(batch, source, target);
  SegmentBatch y(x.columns(), x.first_rows());
  target.read(y.storage());

  for (Index s = 0; s < x.segments(); ++s)
    for (Index j = 0; j < x.columns(); ++j) {
      const auto expected = test::penalised(x.segment(s).col(j), GetParam());
      for (Index i = 0; i < x.rows(s); ++i)
        EXPECT_NEAR(y.segment(s)(i, j), double(expected[static_cast<std::size_t>(i)]),
                    test::tolerance::by_hand(300));
    }
  EXPECT_EQ(padding_of(y), 0);
}

TEST_P(BandedWidth, SolvesALongTake) {
  const SegmentBatch b = random_batch(3, {100'000}, 1);

  const SegmentBatch x = solve_columns(GetParam(), b, weights_like(b), column_penalties(b, 1e8));

  for (Index j = 0; j < 3; ++j) {
    const test::BandSystem system{weights_like(b).segment(0).col(j), b.segment(0).col(j),
                                  column_penalties(b, 1e8)[static_cast<std::size_t>(j)],
                                  GetParam()};
    EXPECT_LE(test::backward_error(system, x.segment(0).col(j)),
              test::tolerance::band_backward_error(GetParam()));
  }
}

TEST_P(BandedWidth, GapsOfWeightZeroAreBridged) {
  SegmentBatch b = random_batch(5, {60}, 1), w = weights_like(b);
  w.segment(0).middleRows(20, 25).setZero();
  const SegmentBatch x = solve_columns(GetParam(), b, w, column_penalties(b, 10));

  const test::BandSystem system{w.segment(0).col(4), b.segment(0).col(4),
                                column_penalties(b, 10)[4], GetParam()};
  EXPECT_LE(test::backward_error(system, x.segment(0).col(4)),
            test::tolerance::band_backward_error(GetParam()));
}

TEST_P(BandedWidth, ResultsDoNotDependOnThePacking) {
  const SegmentBatch b = random_batch(21, {50, 3, 90}, 1), w = weights_like(b);
  const SegmentBatch together = solve_columns(GetParam(), b, w, column_penalties(b, 3));
  const SegmentBatch shared = solve_shared(GetParam(), b, {1, 2, 3}, {30, 20, 10});

  for (Index s = 0; s < b.segments(); ++s) {
    const SegmentBatch own = test::batch_of({b.segment(s)});
    const SegmentBatch alone =
        solve_columns(GetParam(), own, test::batch_of({w.segment(s)}), column_penalties(own, 3));
    const SegmentBatch alone_shared =
        solve_shared(GetParam(), own, {double(s + 1)}, {double(30 - 10 * s)});

    EXPECT_TRUE(test::same_bits(Matrix(alone.segment(0)), Matrix(together.segment(s))));
    EXPECT_TRUE(test::same_bits(Matrix(alone_shared.segment(0)), Matrix(shared.segment(s))));
  }
}

TEST_P(BandedWidth, AColumnWithoutWeightsStaysFinite) {
  const SegmentBatch b = random_batch(9, {20}, 1);
  SegmentBatch w = weights_like(b), right = b;
  w.segment(0).col(4).setZero();
  right.segment(0).col(4).setZero();

  const SegmentBatch x = solve_columns(GetParam(), right, w, column_penalties(b, 1));

  EXPECT_EQ(x.segment(0).col(4).norm(), 0);
  EXPECT_TRUE(x.segment(0).allFinite());
}

INSTANTIATE_TEST_SUITE_P(Widths, BandedWidth, testing::Values(1, 2, 3),
                         testing::PrintToStringParamName());

TEST(Banded, WorksInSinglePrecision) {
  const SegmentBatch shape = random_batch(21, {40}, 1);
  const Device& device = test::device();
  const Batch batch(device, shape, 0, 1);
  const std::vector<float> numbers(shape.storage().begin(), shape.storage().end());
  Buffer<float> x(device, std::span(numbers));
  const std::vector<float> one = {1}, four = {4};
  const Buffer<float> c(device, std::span(one)), q(device, std::span(four));
  Banded<float> banded(device, 2);
  MemoryLayout layout(test::device(), batch);
  SharedBands<float> bands = banded.shared_bands(layout);

  banded.factor(batch, c, q, bands);
  banded.solve(batch, bands, x, x);

  std::vector<float> solved(numbers.size());
  x.read(solved);
  const SegmentBatch expected = solve_shared(2, shape, {1}, {4});
  for (std::size_t i = 0; i < solved.size(); ++i)
    EXPECT_NEAR(solved[i], expected.storage()[i], test::tolerance::single_precision_bands());
}

TEST(Banded, RefusesOtherWidths) {
  EXPECT_THAT([] { Banded<double>(test::device(), 4); },
              testing::ThrowsMessage<ArgumentError>("half-bandwidth is 4, expected 1, 2 or 3"));
}

}  // namespace
}  // namespace moclean
