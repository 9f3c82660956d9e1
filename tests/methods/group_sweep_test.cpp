#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work_group.hpp"
#include "moclean/methods/robust_pca/opencl.hpp"

#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/stacked.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using opencl::BlockReport;
using opencl::SegmentState;
using test::download;
using test::upload;

double soft(double t, double limit) { return t - std::clamp(t, -limit, limit); }

/// The kernels of kernels/robust_pca/sweep_group.cl on two segments of 301 and 7 rows with 5
/// columns, against the steps as methods/robust_pca/reference.cpp has them: mu was 0.5, is 0.7 and
/// will be 1.05.
class GroupSweepTest : public testing::TestWithParam<std::tuple<int, bool>> {
 protected:
  GroupSweepTest()
      : D_(matrix(1)),
        T_(matrix(2)),
        A_(matrix(3)),
        X_(matrix(4)),
        batch_(test::device(), D_, 0, 2),
        program_(test::device(), kernel_source::sweep_group,
                 group_defines(test::device(), work_group())) {
    for (Index b = 0; b < 2; ++b)
      states_.push_back({.mu = 0.7,
                         .mu_next = 1.05,
                         .inverse_last = 2,
                         .lambda = 0.4,
                         .dual_scale = 0.25,
                         .order_ea = ea()});
  }

  static bool ea() { return std::get<1>(GetParam()); }
  static SegmentBatch matrix(std::uint64_t seed) {
    return test::batch_of(
        {test::random_matrix(301, 5, seed), test::random_matrix(7, 5, seed + 100)});
  }
  static int work_group() { return std::get<0>(GetParam()); }
  template <class... Arguments>
  void launch(const std::string& name, const Arguments&... arguments) {
    Kernel kernel(program_, name);
    kernel(group_per_block(batch_, work_group()), batch_.device_segments(), batch_.device_blocks(),
           batch_.active_blocks(),
           Buffer<SegmentState>(test::device(), std::span<const SegmentState>(states_)),
           arguments...);
  }
  template <class Check>
  void for_each_entry(const Check& check) const {
    for (Index b = 0; b < 2; ++b)
      for (Index i = 0; i < D_.rows(b); ++i)
        for (Index j = 0; j < 5; ++j) check(b, i, j);
  }

  SegmentBatch D_, T_, A_, X_;
  Batch batch_;
  Program program_;
  std::vector<SegmentState> states_;
};

TEST_P(GroupSweepTest, StartScalesTheData) {
  const Buffer<double> d = upload(D_);
  Buffer<double> t = upload(T_), a = upload(A_);
  launch("start", d, cl_int{0}, d, t, a);

  const SegmentBatch Y = download(t, D_), A = download(a, D_);
  for_each_entry([&](Index b, Index i, Index j) {
    EXPECT_EQ(Y.segment(b)(i, j), 0.25 * D_.segment(b)(i, j));
    EXPECT_EQ(A.segment(b)(i, j), ea() ? 0 : A_.segment(b)(i, j));
  });
}

// Order ae: Y = clamp(T) and E = soft(T) / 0.5; order ea: Y = T and E from A.
TEST_P(GroupSweepTest, FormGivesWhatIsThresholded) {
  const Buffer<double> d = upload(D_), t = upload(T_), a = upload(A_);
  Buffer<double> e = upload(X_), x = upload(X_);
  launch("form", cl_int{0}, d, t, a, e, x);

  const SegmentBatch E = download(e, D_), X = download(x, D_);
  for_each_entry([&](Index b, Index i, Index j) {
    const double data = D_.segment(b)(i, j), kept = T_.segment(b)(i, j);
    const double dual = ea() ? kept : std::clamp(kept, -0.4, 0.4);
    const double sparse =
        ea() ? soft(data - A_.segment(b)(i, j) + dual / 0.7, 0.4 / 0.7) : soft(kept, 0.4) / 0.5;
    EXPECT_NEAR(X.segment(b)(i, j), data - sparse + dual / 0.7, test::tolerance::by_hand(16));
    EXPECT_NEAR(E.segment(b)(i, j), ea() ? sparse : X_.segment(b)(i, j),
                test::tolerance::by_hand(8));
  });
}

TEST_P(GroupSweepTest, ShrinkIsTheStepOfTheReference) {
  const Buffer<double> d = upload(D_), x = upload(X_), a = upload(A_);
  Buffer<double> t = upload(T_);
  Buffer<BlockReport> of_blocks(test::device(), batch_.block_count());
  std::vector<BlockReport> reports(batch_.block_count());
  launch("shrink", d, cl_int{0}, d, x, a, t, of_blocks);
  of_blocks.read(reports);

  const SegmentBatch T = download(t, D_);
  double residual[2] = {0, 0}, sum[2] = {0, 0};
  for_each_entry([&](Index b, Index i, Index j) {
    const double a_entry = A_.segment(b)(i, j), kept = T_.segment(b)(i, j);
    const double dual = ea() ? kept : std::clamp(kept, -0.4, 0.4);
    const double next =
        ea() ? 0.7 * (X_.segment(b)(i, j) - a_entry) : 0.7 * (D_.segment(b)(i, j) - a_entry) + dual;
    const double dual_next = ea() ? next : std::clamp(next, -0.4, 0.4);
    EXPECT_NEAR(T.segment(b)(i, j), next, test::tolerance::by_hand(8));
    residual[b] += std::pow((dual_next - dual) / 0.7, 2);
  });
  for (std::size_t k = 0; k < reports.size(); ++k) {
    sum[static_cast<Index>(k) < batch_.segment(1).first_block ? 0 : 1] += reports[k].squares;
    EXPECT_EQ(reports[k].sparse, ea() ? 0 : 1);
  }
  for (Index b = 0; b < 2; ++b)
    EXPECT_NEAR(sum[b], residual[b], 2 * test::tolerance::sum_of_products(D_.rows(b) * 5, 1));
}

TEST_P(GroupSweepTest, ShrinkKeepsThePaddingZeroAndLeavesFinishedSegmentsAlone) {
  states_[0].finished = 1;
  const Buffer<double> d = upload(D_), x = upload(X_), a = upload(A_);
  Buffer<double> t = upload(T_);
  Buffer<BlockReport> reports(test::device(), batch_.block_count());
  launch("shrink", d, cl_int{0}, d, x, a, t, reports);

  const SegmentBatch T = download(t, D_);
  EXPECT_TRUE(test::same_bits(Matrix(T.segment(0)), Matrix(T_.segment(0))));
  EXPECT_FALSE(test::same_bits(Matrix(T.segment(1)), Matrix(T_.segment(1))));
  const Eigen::Map<const Matrix> rows(T.storage().data(), T.rows(), T.pitch());
  EXPECT_EQ(rows.rightCols(T.pitch() - 5).cwiseAbs().sum(), 0);
}

TEST_P(GroupSweepTest, FinishGivesTheSparsePart) {
  const Buffer<double> e = upload(X_);
  Buffer<double> t = upload(T_);
  launch("finish", e, t);

  const SegmentBatch E = download(t, D_);
  for_each_entry([&](Index b, Index i, Index j) {
    const double kept = T_.segment(b)(i, j);
    EXPECT_NEAR(E.segment(b)(i, j), ea() ? X_.segment(b)(i, j) : soft(kept, 0.4) / 0.5,
                test::tolerance::by_hand(8));
    if (!ea() && std::abs(kept) <= 0.4) {
      EXPECT_EQ(E.segment(b)(i, j), 0);
    }
  });
}

std::string name_of_group_sweep(const testing::TestParamInfo<std::tuple<int, bool>>& info) {
  const auto& [work_group, ea] = info.param;
  return "WG" + std::to_string(work_group) + (ea ? "_ea" : "_ae");
}

INSTANTIATE_TEST_SUITE_P(Orders, GroupSweepTest,
                         testing::Combine(testing::Values(64, 128, 256), testing::Bool()),
                         name_of_group_sweep);

}  // namespace
}  // namespace moclean
