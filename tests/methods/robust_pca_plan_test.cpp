#include <vector>

#include <gtest/gtest.h>

#include "moclean/methods/robust_pca/opencl_plan.hpp"

namespace moclean::opencl {
namespace {

using Gram = Iteration::Gram;
using Update = Iteration::Update;
using Vectors = Iteration::Vectors;

// tau falls by 100 from 0.8 and is below 6e-7 from the fifth iteration on.
constexpr RobustPca steep(UpdateOrder order = UpdateOrder::ae) {
  return {.rho = 100, .mu_max_factor = 1e9, .order = order};
}

std::vector<Iteration> plan(const RobustPca& method, const IterationSetting& setting, int count) {
  std::vector<Iteration> iterations = {first_iteration(method, setting)};
  while (static_cast<int>(iterations.size()) < count)
    iterations.push_back(next_iteration(iterations.back(), method, setting));
  return iterations;
}

TEST(RobustPcaPlan, SweepsHandOnTheGramMatrixUntilItIsGraded) {
  const auto iterations = plan(steep(), {.fused = true, .columns = true}, 6);

  for (std::size_t i = 0; i < 4; ++i) {
    const bool last = i == 3;  // before graded ones
    EXPECT_EQ(iterations[i].gram, Gram::last_sweep) << i;
    EXPECT_EQ(iterations[i].vectors, last ? Vectors::all : Vectors::thresholded) << i;
    EXPECT_EQ(iterations[i].update, last ? Update::sweep : Update::sweep_with_gram) << i;
    EXPECT_TRUE(iterations[i].low_rank) << i;
    EXPECT_FALSE(iterations[i].whole_x()) << i;
  }
  for (std::size_t i = 4; i < 6; ++i) {
    EXPECT_EQ(iterations[i].gram, Gram::rotated) << i;
    EXPECT_EQ(iterations[i].vectors, Vectors::all) << i;
    EXPECT_EQ(iterations[i].update, Update::sweep) << i;
    EXPECT_FALSE(iterations[i].low_rank) << i;
    EXPECT_TRUE(iterations[i].whole_x()) << i;
  }
}

TEST(RobustPcaPlan, FirstIterationOfOrderEaNeedsItsXAsAWhole) {
  const auto iterations = plan(steep(UpdateOrder::ea), {.fused = true}, 2);

  EXPECT_EQ(iterations[0].gram, Gram::whole_matrix);
  EXPECT_EQ(iterations[0].update, Update::sweep_with_gram);
  EXPECT_EQ(iterations[1].gram, Gram::last_sweep);
}

TEST(RobustPcaPlan, WithoutASweepEveryMatrixIsFormedAsAWhole) {
  for (const Iteration& iteration : plan(steep(), {.columns = true}, 6)) {
    EXPECT_TRUE(iteration.whole_x());
    EXPECT_EQ(iteration.update, Update::whole_matrices);
    EXPECT_FALSE(iteration.low_rank);
  }
}

TEST(RobustPcaPlan, SinglePrecisionIsNeverGraded) {
  const IterationSetting setting = {.mixed = true, .fused = true, .columns = true};

  for (const Iteration& iteration : plan(steep(), setting, 6)) {
    EXPECT_EQ(iteration.gram, Gram::single_floats);
    EXPECT_EQ(iteration.vectors, Vectors::thresholded);
    EXPECT_EQ(iteration.update, Update::sweep);
    EXPECT_TRUE(iteration.low_rank);
  }
}

TEST(RobustPcaPlan, PenaltyStopsGrowingAtItsLargest) {
  const RobustPca method = {.rho = 10, .mu0_factor = 2, .mu_max_factor = 50};

  const auto iterations = plan(method, {.fused = true}, 4);

  EXPECT_DOUBLE_EQ(iterations[0].tau, 0.5);
  EXPECT_DOUBLE_EQ(iterations[1].tau, 0.05);
  EXPECT_DOUBLE_EQ(iterations[2].tau, 0.01);
  EXPECT_EQ(iterations[3].number, 3);
  EXPECT_EQ(iterations[3].tau, iterations[2].tau);
}

// The residual falls by at most 4 rho / 1.5, here by 4: from 1 to 1e-7 in no less than 11.6
// iterations.
TEST(RobustPcaPlan, LooksNoSoonerThanASegmentCanHaveFinished) {
  const RobustPca method = {.rho = 1.5, .tolerance = 1e-7};
  const IterationSetting setting = {.fused = true};
  const auto iterations = plan(method, setting, 2);

  EXPECT_EQ(iterations_until_look(iterations[0], 1, method), 1);
  EXPECT_EQ(iterations_until_look(iterations[1], 1, method), 11);
  EXPECT_EQ(iterations_until_look(iterations[1], 2e-7, method), 1);
  EXPECT_EQ(iterations_until_look(plan(method, {}, 2)[1], 1, method), 1);
}

}  // namespace
}  // namespace moclean::opencl
