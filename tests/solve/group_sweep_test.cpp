#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "moclean/device/kernel_source.hpp"
#include "moclean/solve/opencl/robust_pca.hpp"

#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using opencl::SegmentState;

double soft(double t, double limit) { return t - std::clamp(t, -limit, limit); }

/// The kernels of kernels/sweep_group.cl on two segments of 301 and 7 rows with 5 columns, against
/// the steps as solve/reference/robust_pca.cpp has them.
class GroupSweepTest : public testing::TestWithParam<std::tuple<int, bool>> {
 protected:
  GroupSweepTest()
      : D_(matrix(1)),
        Y_(matrix(2)),
        A_(matrix(3)),
        E_(matrix(4)),
        batch_(test::device(), D_, 0, 2),
        program_(test::device(), kernel_source::sweep_group, defines()),
        X_(D_) {
    for (Index b = 0; b < 2; ++b) {
      states_.push_back({.mu = 0.7, .mu_next = 1.05, .lambda = 0.4, .order_ea = ea()});
      X_.segment(b) = D_.segment(b) - E_.segment(b) + Y_.segment(b) / 0.7;
    }
  }

  static bool ea() { return std::get<1>(GetParam()); }
  static SegmentBatch matrix(std::uint64_t seed) {
    return test::batch_of(
        {test::random_matrix(301, 5, seed), test::random_matrix(7, 5, seed + 100)});
  }
  static Defines defines() {
    Defines defines = common_defines(test::device());
    defines["WG"] = std::to_string(std::get<0>(GetParam()));
    return defines;
  }
  static Buffer<double> upload(const SegmentBatch& rows) {
    return Buffer<double>(test::device(), rows.storage());
  }
  static SegmentBatch download(const Buffer<double>& buffer, const SegmentBatch& like) {
    SegmentBatch rows(like.columns(), like.first_rows());
    buffer.read(rows.storage());
    return rows;
  }
  Grid groups() const {
    const auto width = static_cast<std::size_t>(std::get<0>(GetParam()));
    return {.x = width * static_cast<std::size_t>(batch_.active_blocks()), .group_x = width};
  }
  Buffer<SegmentState> states() const {
    return Buffer<SegmentState>(test::device(), std::span<const SegmentState>(states_));
  }

  SegmentBatch D_, Y_, A_, E_;
  Batch batch_;
  Program program_;
  SegmentBatch X_;
  std::vector<SegmentState> states_;
};

TEST_P(GroupSweepTest, StartIsTheStartOfTheReference) {
  for (SegmentState& state : states_) state.dual_scale = 0.25;
  const Buffer<double> d = upload(D_);
  Buffer<double> y = upload(Y_), x = upload(X_), e = upload(E_);

  Kernel start(program_, "start");
  start(groups(), batch_.device_segments(), batch_.device_blocks(), batch_.active_blocks(),
        states(), d, y, x, e);

  const SegmentBatch Y = download(y, D_), X = download(x, D_), E = download(e, D_);
  for (Index b = 0; b < 2; ++b)
    for (Index i = 0; i < D_.rows(b); ++i)
      for (Index j = 0; j < 5; ++j) {
        const double entry = D_.segment(b)(i, j), dual = 0.25 * entry;
        const double sparse = ea() ? soft(entry + dual / 0.7, 0.4 / 0.7) : 0;
        EXPECT_EQ(Y.segment(b)(i, j), dual);
        EXPECT_NEAR(X.segment(b)(i, j), entry - sparse + dual / 0.7, test::tolerance::by_hand(8));
        EXPECT_NEAR(E.segment(b)(i, j), ea() ? sparse : E_.segment(b)(i, j),
                    test::tolerance::by_hand(8));
      }
}

TEST_P(GroupSweepTest, ShrinkIsTheStepOfTheReference) {
  const Buffer<double> d = upload(D_), x = upload(X_);
  Buffer<double> y = upload(Y_), a = upload(A_), e_next = upload(E_);
  Buffer<double> squares(test::device(), batch_.block_count());
  Buffer<std::int32_t> sparse(test::device(), batch_.block_count());
  std::vector<double> sums(batch_.block_count());
  std::vector<std::int32_t> flags(batch_.block_count());

  Kernel shrink(program_, "shrink");
  shrink(groups(), batch_.device_segments(), batch_.device_blocks(), batch_.active_blocks(),
         states(), d, x, y, a, e_next, squares, sparse);
  squares.read(sums);
  sparse.read(flags);

  const SegmentBatch Y = download(y, D_), X = download(a, D_), E_next = download(e_next, D_);
  for (Index b = 0; b < 2; ++b) {
    double residual = 0;
    for (Index i = 0; i < D_.rows(b); ++i)
      for (Index j = 0; j < 5; ++j) {
        const double gap = D_.segment(b)(i, j) - A_.segment(b)(i, j), dual = Y_.segment(b)(i, j);
        const double e = ea() ? E_.segment(b)(i, j) : soft(gap + dual / 0.7, 0.4 / 0.7);
        const double dual_next = dual + 0.7 * (gap - e);
        const double kept = ea() ? soft(gap + dual_next / 1.05, 0.4 / 1.05) : e;
        EXPECT_NEAR(Y.segment(b)(i, j), dual_next, test::tolerance::by_hand(4));
        EXPECT_NEAR(X.segment(b)(i, j), D_.segment(b)(i, j) - kept + dual_next / 1.05,
                    test::tolerance::by_hand(8));
        EXPECT_NEAR(E_next.segment(b)(i, j), ea() ? kept : E_.segment(b)(i, j),
                    test::tolerance::by_hand(4));
        residual += (gap - e) * (gap - e);
      }
    double sum = 0;
    for (Index k = batch_.segment(b).first_block;
         k < (b == 0 ? batch_.segment(1).first_block : std::ssize(sums)); ++k) {
      sum += sums[static_cast<std::size_t>(k)];
      EXPECT_EQ(flags[static_cast<std::size_t>(k)], ea() ? 0 : 1);
    }
    EXPECT_NEAR(sum, residual, test::tolerance::sum_of_products(D_.rows(b) * 5, 1));
  }
}

TEST_P(GroupSweepTest, ShrinkKeepsThePaddingZeroAndLeavesFinishedSegmentsAlone) {
  states_[0].finished = 1;
  const Buffer<double> d = upload(D_), x = upload(X_);
  Buffer<double> y = upload(Y_), a = upload(A_), e_next = upload(E_);
  Buffer<double> squares(test::device(), batch_.block_count());
  Buffer<std::int32_t> sparse(test::device(), batch_.block_count());

  Kernel shrink(program_, "shrink");
  shrink(groups(), batch_.device_segments(), batch_.device_blocks(), batch_.active_blocks(),
         states(), d, x, y, a, e_next, squares, sparse);

  const SegmentBatch Y = download(y, D_), X = download(a, D_);
  EXPECT_TRUE(test::same_bits(Matrix(Y.segment(0)), Matrix(Y_.segment(0))));
  EXPECT_TRUE(test::same_bits(Matrix(X.segment(0)), Matrix(A_.segment(0))));
  EXPECT_FALSE(test::same_bits(Matrix(Y.segment(1)), Matrix(Y_.segment(1))));
  const Eigen::Map<const Matrix> rows(X.storage().data(), X.rows(), X.pitch());
  EXPECT_EQ(rows.rightCols(X.pitch() - 5).cwiseAbs().sum(), 0);
}

// After three iterations the last one read X from x_even and wrote X+ to x_odd.
TEST_P(GroupSweepTest, FinishGivesTheSparsePartAndTheXOfTheLastIteration) {
  const SegmentBatch X_next = matrix(5);
  for (SegmentState& state : states_) state.iterations = 3;
  Buffer<double> even = upload(X_), odd = upload(X_next), y = upload(Y_);
  const Buffer<double> d = upload(D_), e_even = upload(E_), e_odd = upload(A_);

  Kernel finish(program_, "finish");
  finish(groups(), batch_.device_segments(), batch_.device_blocks(), batch_.active_blocks(),
         states(), even, odd, e_even, e_odd, d, y);

  const SegmentBatch E = download(y, D_);
  for (Index b = 0; b < 2; ++b)
    for (Index i = 0; i < D_.rows(b); ++i)
      for (Index j = 0; j < 5; ++j) {
        const double dual = Y_.segment(b)(i, j);
        const double sparse =
            std::abs(dual) < 0.4 ? 0 : D_.segment(b)(i, j) + dual / 0.7 - X_next.segment(b)(i, j);
        EXPECT_NEAR(E.segment(b)(i, j), ea() ? E_.segment(b)(i, j) : sparse,
                    test::tolerance::by_hand(8));
      }
  EXPECT_TRUE(test::same_bits(download(even, D_), X_));
  EXPECT_TRUE(test::same_bits(download(odd, D_), X_));
}

std::string name_of(const testing::TestParamInfo<std::tuple<int, bool>>& info) {
  const auto& [work_group, ea] = info.param;
  return "WG" + std::to_string(work_group) + (ea ? "_ea" : "_ae");
}

INSTANTIATE_TEST_SUITE_P(Orders, GroupSweepTest,
                         testing::Combine(testing::Values(64, 128, 256), testing::Bool()), name_of);

}  // namespace
}  // namespace moclean
