#include <gtest/gtest.h>

#include "moclean/backend/opencl_backend.hpp"
#include "moclean/backend/reference_backend.hpp"

#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/planted.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::Shape;

void expect_same_parts(const Solution& device, const Solution& reference, Index b) {
  EXPECT_LE(test::relative_difference(device.low_rank.segment(b), reference.low_rank.segment(b)),
            test::tolerance::mixed_low_rank());
  EXPECT_LE(test::relative_difference(device.sparse.segment(b), reference.sparse.segment(b)),
            test::tolerance::mixed_sparse());
}

class MixedPrecision : public testing::TestWithParam<std::tuple<UpdateOrder, Shape>> {
 protected:
  OpenClBackend backend_{test::device(), {.precision = Precision::mixed}};
  RobustPca method_{.tolerance = mixed_tolerance, .order = std::get<0>(GetParam())};
  SegmentBatch data_ =
      test::planted_batch({.columns = std::get<1>(GetParam()).columns,
                           .rank = 1 + std::get<1>(GetParam()).columns / 10},
                          {std::get<1>(GetParam()).rows, std::get<1>(GetParam()).rows + 300,
                           std::get<1>(GetParam()).rows});
};

TEST_P(MixedPrecision, IsWithinItsBoundsOfTheReference) {
  const Solution device = backend_.solve(data_, method_);
  const Solution reference = ReferenceBackend(2).solve(data_, method_);

  for (Index b = 0; b < data_.segments(); ++b) {
    const auto i = static_cast<std::size_t>(b);
    // A residual that the reference finds just below the tolerance may be just above in float.
    EXPECT_NEAR(device.segments[i].iterations, reference.segments[i].iterations, 1);
    EXPECT_TRUE(device.segments[i].converged);
    expect_same_parts(device, reference, b);
  }
}

TEST_P(MixedPrecision, ResultsDoNotDependOnTheNeighbours) {
  const Solution together = backend_.solve(data_, method_);

  for (Index b = 0; b < data_.segments(); ++b) {
    SegmentBatch one(data_.columns(), {0, data_.rows(b)});
    one.segment(0) = data_.segment(b);
    const Solution alone = backend_.solve(one, method_);
    EXPECT_TRUE(
        test::same_bits(Matrix(together.low_rank.segment(b)), Matrix(alone.low_rank.segment(0))));
    EXPECT_TRUE(
        test::same_bits(Matrix(together.sparse.segment(b)), Matrix(alone.sparse.segment(0))));
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, MixedPrecision,
                         testing::Combine(testing::Values(UpdateOrder::ae, UpdateOrder::ea),
                                          testing::Values(Shape{3, 5}, Shape{200, 93},
                                                          Shape{25, 93}, Shape{64, 64})));

// All kernels, in so few steps that Oclgrind, which interprets them, is soon done; 257 rows are two
// blocks.
TEST(MixedPrecisionFirstIterations, AgreeOnATinyProblem) {
  OpenClBackend backend(test::device(), {.precision = Precision::mixed});
  const SegmentBatch data = test::planted_batch({.columns = 5, .rank = 1}, {3, 257});
  const RobustPca method{.tolerance = mixed_tolerance, .max_iterations = 2};

  const Solution device = backend.solve(data, method);
  const Solution reference = ReferenceBackend().solve(data, method);

  for (Index b = 0; b < data.segments(); ++b) expect_same_parts(device, reference, b);
}

TEST(MixedPrecisionBackend, RefusesAToleranceItCannotReach) {
  OpenClBackend backend(test::device(), {.precision = Precision::mixed});

  EXPECT_THROW(backend.solve(test::planted_batch({.columns = 5}, {9}), RobustPca{}), ArgumentError);
}

TEST(MixedPrecisionBackend, RefusesTheFormAndTheProductsThatItHasNot) {
  EXPECT_THROW(
      OpenClBackend(test::device(), {.form = KernelForm::gpu, .precision = Precision::mixed}),
      ArgumentError);
  EXPECT_THROW(OpenClBackend(test::device(),
                             {.products = ProductPath::clblast, .precision = Precision::mixed}),
               ArgumentError);
}

}  // namespace
}  // namespace moclean
