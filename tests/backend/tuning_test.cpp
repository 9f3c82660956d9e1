// Every choice of a tuning against the default, on tall, square and wide segments.

#include <algorithm>
#include <string_view>

#include <gmock/gmock.h>

#include "moclean/backend/opencl_backend.hpp"

#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/planted.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

const Tuning small_choices{
    .tile_rows = 5, .tile_vectors = 1, .sweep_rows = 7, .panel = 1, .batch_segments = 1};
const Tuning large_choices{.tile_rows = 4, .tile_vectors = 4, .sweep_rows = 64, .panel = 8};

SegmentBatch usual_segments() {
  return test::planted_batch({.columns = 93, .rank = 7}, {25, 200, 93, 300});
}

SegmentBatch tiny_segments() {
  return test::planted_batch({.columns = 5, .rank = 1}, {3, 9, 5, 1});
}

RobustPca method_of(UpdateOrder order, Precision precision) {
  return {.tolerance = precision == Precision::mixed ? mixed_tolerance : 1e-7, .order = order};
}

void expect_untuned_bits(const Solution& a, const Solution& b) {
  for (Index s = 0; s < a.low_rank.segments(); ++s) {
    const auto i = static_cast<std::size_t>(s);
    EXPECT_TRUE(test::same_bits(Matrix(a.low_rank.segment(s)), Matrix(b.low_rank.segment(s))));
    EXPECT_TRUE(test::same_bits(Matrix(a.sparse.segment(s)), Matrix(b.sparse.segment(s))));
    EXPECT_EQ(a.segments[i].iterations, b.segments[i].iterations);
    EXPECT_EQ(a.segments[i].rank, b.segments[i].rank);
    // Summed over tiles, so the order of the sum is that of the tuning.
    EXPECT_NEAR(a.segments[i].residual, b.segments[i].residual,
                test::tolerance::mixed_low_rank() * b.segments[i].residual);
  }
}

void expect_close(const Solution& a, const Solution& b) {
  for (Index s = 0; s < a.low_rank.segments(); ++s) {
    const auto i = static_cast<std::size_t>(s);
    EXPECT_LE(test::relative_difference(a.low_rank.segment(s), b.low_rank.segment(s)),
              test::tolerance::backends_low_rank());
    EXPECT_LE(test::relative_difference(a.sparse.segment(s), b.sparse.segment(s)),
              test::tolerance::backends_sparse());
    EXPECT_EQ(a.segments[i].iterations, b.segments[i].iterations);
    EXPECT_EQ(a.segments[i].rank, b.segments[i].rank);
  }
}

struct TuningCase {
  UpdateOrder order;
  Precision precision;
};

class TuningTest : public testing::TestWithParam<TuningCase> {};

TEST_P(TuningTest, TilesSweepsPanelsAndBatchesLeaveEveryBit) {
  const auto [order, precision] = GetParam();

  const SegmentBatch batches[] = {usual_segments(), tiny_segments()};
  const RobustPca method = method_of(order, precision);
  OpenClBackend usual(test::device(), {.precision = precision, .tuning = Tuning{}});

  for (const Tuning& tuning : {small_choices, large_choices}) {
    OpenClBackend tuned(test::device(), {.precision = precision, .tuning = tuning});
    for (const SegmentBatch& data : batches) {
      SCOPED_TRACE(to_string(tuning));
      expect_untuned_bits(tuned.solve(data, method), usual.solve(data, method));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, TuningTest,
                         testing::Values(TuningCase{UpdateOrder::ae, Precision::f64},
                                         TuningCase{UpdateOrder::ea, Precision::f64},
                                         TuningCase{UpdateOrder::ae, Precision::mixed}));

TEST(Tuning, GroupFormOfTheEigensolverAgreesWithTheLanes) {
  OpenClBackend group(test::device(), {.tuning = Tuning{.eigen = KernelForm::gpu}});
  OpenClBackend lanes(test::device(), {.tuning = Tuning{.eigen = KernelForm::cpu}});

  for (const UpdateOrder order : {UpdateOrder::ae, UpdateOrder::ea})
    for (const SegmentBatch& data : {usual_segments(), tiny_segments()}) {
      const RobustPca method{.order = order};
      expect_close(group.solve(data, method), lanes.solve(data, method));
    }
}

TEST(Tuning, GroupFormDoesNotDependOnTheNeighbours) {
  const Tuning together{.eigen = KernelForm::gpu};
  const Tuning alone{.eigen = KernelForm::gpu, .batch_segments = 1};
  const SegmentBatch data = usual_segments();

  expect_untuned_bits(OpenClBackend(test::device(), {.tuning = together}).solve(data, RobustPca{}),
                      OpenClBackend(test::device(), {.tuning = alone}).solve(data, RobustPca{}));
}

TEST(Tuning, WorkGroupsOfTheGpuFormLeaveEveryBit) {
  const auto solve = [](const RobustPca& method, int work_group) {
    const Tuning tuning{.form = KernelForm::gpu, .work_group = work_group};
    const SegmentBatch data = test::planted_batch({.columns = 31, .rank = 3}, {25, 70, 31, 300});
    return OpenClBackend(test::device(), {.tuning = tuning}).solve(data, method);
  };

  for (const UpdateOrder order : {UpdateOrder::ae, UpdateOrder::ea}) {
    const RobustPca method{.order = order};
    const Solution expected = solve(method, 256);
    for (const int work_group : {64, 128}) expect_untuned_bits(solve(method, work_group), expected);
  }
}

TEST(Tuning, OutOfItsRangeIsRejected) {
  for (const Tuning& tuning :
       {Tuning{.tile_rows = 0}, Tuning{.tile_rows = 17}, Tuning{.tile_vectors = 9},
        Tuning{.sweep_rows = 257}, Tuning{.panel = 0}, Tuning{.batch_segments = -1},
        Tuning{.work_group = 8}, Tuning{.work_group = 512}, Tuning{.queues = 0},
        Tuning{.queues = 65}})
    EXPECT_THROW(OpenClBackend(test::device(), {.tuning = tuning}), ArgumentError);
}

TEST(Tuning, DefaultFormsFollowTheKindOfDevice) {
  DeviceInfo cpu, gpu;
  cpu.kind = DeviceKind::cpu;
  gpu.kind = DeviceKind::gpu;

  EXPECT_EQ(default_tuning(cpu).eigen, KernelForm::cpu);
  EXPECT_EQ(default_tuning(cpu).form, KernelForm::cpu);
  EXPECT_EQ(default_tuning(gpu).eigen, KernelForm::gpu);
  EXPECT_EQ(default_tuning(gpu).form, KernelForm::gpu);
  EXPECT_EQ(default_tuning(gpu).products, ProductPath::own);
  EXPECT_EQ(default_tuning(gpu).work_group, 64);
}

TEST(Tuning, DefaultQueuesFollowTheComputeUnitsOfACpu) {
  const auto queues = [](DeviceKind kind, int compute_units) {
    DeviceInfo info;
    info.kind = kind;
    info.compute_units = compute_units;
    return default_tuning(info).queues;
  };

  EXPECT_EQ(queues(DeviceKind::cpu, 1), 1);
  EXPECT_EQ(queues(DeviceKind::cpu, 2), 2);
  EXPECT_EQ(queues(DeviceKind::cpu, 64), 4);
  EXPECT_EQ(queues(DeviceKind::gpu, 64), 1);
  EXPECT_EQ(queues(DeviceKind::other, 64), 1);
}

TEST(Tuning, ForAnotherFormOrProductsServesMixedPrecisionWithItsOwn) {
  const Tuning other{.form = KernelForm::gpu, .products = ProductPath::clblast};
  const OpenClBackend backend(test::device(), {.precision = Precision::mixed, .tuning = other});

  EXPECT_EQ(backend.tuning().form, KernelForm::cpu);
  EXPECT_EQ(backend.tuning().products, ProductPath::own);
}

TEST(Tuning, OptionsOverrideItsFormAndItsProducts) {
  const Tuning kept{.form = KernelForm::gpu, .products = ProductPath::clblast};

  const OpenClBackend form(test::device(), {.form = KernelForm::cpu, .tuning = kept});
  const OpenClBackend products(test::device(), {.products = ProductPath::own, .tuning = kept});

  EXPECT_EQ(to_string(form.tuning().form), "cpu");
  EXPECT_EQ(to_string(form.tuning().products), "clblast");
  EXPECT_EQ(to_string(products.tuning().form), "gpu");
  EXPECT_EQ(to_string(products.tuning().products), "own");
  EXPECT_THAT(form.name(), testing::HasSubstr(", form cpu, products clblast)"));
}

TEST(Tuning, GpuFormAgreesWithEitherProducts) {
  const Tuning gpu{.form = KernelForm::gpu};
  const Tuning with_clblast{.form = KernelForm::gpu, .products = ProductPath::clblast};
  OpenClBackend own(test::device(), {.tuning = gpu});
  OpenClBackend clblast(test::device(), {.tuning = with_clblast});

  for (const UpdateOrder order : {UpdateOrder::ae, UpdateOrder::ea})
    expect_close(clblast.solve(tiny_segments(), RobustPca{.order = order}),
                 own.solve(tiny_segments(), RobustPca{.order = order}));
  const SegmentBatch data = test::planted_batch({.columns = 6, .rank = 2}, {40, 90});
  for (const Method& method : {Method(TemporalRobustPca{}), Method(MatrixNormal{})}) {
    const Solution a = clblast.solve(data, method), b = own.solve(data, method);
    for (Index s = 0; s < data.segments(); ++s)
      EXPECT_LE(test::relative_difference(a.low_rank.segment(s), b.low_rank.segment(s)),
                test::tolerance::backends_smoothing());
  }
}

TEST(Tuning, NamesOfFormsAndProductsAreReadBack) {
  for (const KernelForm form : {KernelForm::cpu, KernelForm::gpu})
    EXPECT_EQ(parse_kernel_form(to_string(form)), form);
  for (const ProductPath products : {ProductPath::own, ProductPath::clblast})
    EXPECT_EQ(parse_product_path(to_string(products)), products);
  EXPECT_THROW(parse_kernel_form("group"), ArgumentError);
  EXPECT_THROW(parse_product_path("gpu"), ArgumentError);
}

TEST(Profiling, LeavesResultsAsTheyAreAndSeesEveryIteration) {
  const Device profiled(test::device().info().name, Profiling::on);
  const SegmentBatch data = usual_segments();

  const Solution solution = OpenClBackend(profiled, {.tuning = Tuning{}}).solve(data, RobustPca{});

  OpenClBackend usual(test::device(), {.tuning = Tuning{}});
  expect_untuned_bits(solution, usual.solve(data, RobustPca{}));
  int iterations = 0;
  for (const SegmentOutcome& segment : solution.segments)
    iterations = std::max(iterations, segment.iterations);
  const auto kernels = profiled.profile()->kernels();
  double flops = 0;
  for (const char* name : {"sweep_full", "sweep_low_rank", "sweep_wide"}) {
    const auto sweep = std::ranges::find(kernels, name, &KernelProfile::kernel);
    ASSERT_NE(sweep, kernels.end()) << name;
    ASSERT_TRUE(sweep->work) << name;
    if (std::string_view(name) == "sweep_full") {
      EXPECT_GE(sweep->calls, iterations);
    }
    flops += sweep->work->flops;
  }
  // A = XW, its Gram matrix and 12 flops per entry are an upper bound; low rank takes less.
  const double entries = (25.0 + 200 + 93 + 300) * 93;
  EXPECT_LE(flops, iterations * entries * (2 * 93 + 94 + 12));
  EXPECT_GT(flops, iterations * entries * 12);
}

TEST(Profiling, KnowsTheWorkOfProductsInWorkGroups) {
  const Device profiled(test::device().info().name, Profiling::on);
  const Tuning tuning{.form = KernelForm::gpu, .work_group = 128, .eigen = KernelForm::gpu};
  const SegmentBatch data = test::planted_batch({.columns = 31, .rank = 3}, {25, 70});

  const Solution solution = OpenClBackend(profiled, {.tuning = tuning}).solve(data, RobustPca{});

  OpenClBackend usual(test::device(), {.tuning = tuning});
  expect_untuned_bits(solution, usual.solve(data, RobustPca{}));
  const auto kernels = profiled.profile()->kernels();
  for (const char* name : {"gram", "apply", "reconstruct", "shrink"}) {
    const auto kernel = std::ranges::find(kernels, name, &KernelProfile::kernel);
    ASSERT_NE(kernel, kernels.end()) << name;
    ASSERT_TRUE(kernel->work) << name;
    EXPECT_GT(kernel->work->flops, 0) << name;
  }
  for (const KernelProfile& kernel : kernels) EXPECT_FALSE(kernel.kernel.starts_with("sweep"));
}

}  // namespace
}  // namespace moclean
