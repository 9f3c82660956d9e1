#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work_group.hpp"

#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/stacked.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::download;
using test::upload;

// What kernels/temporal_robust_pca/temporal_group.cl makes of two segments of 301 and 7 rows with 5
// columns; mu was 0.5 and 0.8, will be 0.75 and 1.2.
struct Updated {
  SegmentBatch X, E, Y, U, next;
  std::vector<double> gaps, splits;  // of all blocks
};

class GroupTemporalTest : public testing::TestWithParam<int> {
 protected:
  static SegmentBatch matrix(std::uint64_t seed) {
    return test::batch_of(
        {test::random_matrix(301, 5, seed), test::random_matrix(7, 5, seed + 100)});
  }
  static SegmentBatch pattern() {  // every third sample is missing
    SegmentBatch observed = matrix(9);
    for (Index b = 0; b < 2; ++b)
      for (Index i = 0; i < observed.rows(b); ++i)
        for (Index j = 0; j < 5; ++j) observed.segment(b)(i, j) = (i + j) % 3 > 0;
    return observed;
  }

  Updated run(int work_group) const {
    const Device& device = test::device();
    const Batch batch(device, D_, 0, 2);
    const Program program(device, kernel_source::temporal_group, group_defines(device, work_group));
    Kernel shift(program, "shift"), update(program, "update");
    const Grid grid = group_per_block(batch, work_group);
    const Buffer<double> mus(device, std::span(mu_)), next_mus(device, std::span(mu_next_)),
        lambdas(device, std::span(lambda_)), d = upload(D_), p = upload(P_), s = upload(S_),
                                             l = upload(L_);
    Buffer<double> x = upload(E_), e = upload(E_), y = upload(Y_), u = upload(U_),
                   next = upload(E_);
    Buffer<double> gaps(device, batch.block_count()), splits(device, batch.block_count());
    shift(grid, batch.device_segments(), batch.device_blocks(), batch.active_blocks(), mus, s, u,
          x);
    update(grid, batch.device_segments(), batch.device_blocks(), batch.active_blocks(), mus,
           next_mus, lambdas, d, p, s, l, e, y, u, next, gaps, splits);

    std::vector<double> gap(batch.block_count()), split(batch.block_count());
    gaps.read(gap);
    splits.read(split);
    return {download(x, D_),
            download(e, D_),
            download(y, D_),
            download(u, D_),
            download(next, D_),
            gap,
            split};
  }

  const std::vector<double> mu_ = {0.5, 0.8}, mu_next_ = {0.75, 1.2}, lambda_ = {0.3, 0.4};
  const SegmentBatch D_ = matrix(1), P_ = pattern(), S_ = matrix(2), L_ = matrix(3), E_ = matrix(4),
                     Y_ = matrix(5), U_ = matrix(6);
};

TEST_P(GroupTemporalTest, TakesTheStepsOfTheReference) {
  const Updated after = run(GetParam());

  double gap[2] = {0, 0}, split[2] = {0, 0};
  for (Index b = 0; b < 2; ++b)
    for (Index i = 0; i < D_.rows(b); ++i)
      for (Index j = 0; j < 5; ++j) {
        const auto k = static_cast<std::size_t>(b);
        const double mu = mu_[k], next = mu_next_[k], limit = lambda_[k] * P_.segment(b)(i, j);
        const double d = D_.segment(b)(i, j), s = S_.segment(b)(i, j), l = L_.segment(b)(i, j);
        const double t = d - s + Y_.segment(b)(i, j) / mu;
        const double y = std::clamp(mu * t, -limit, limit), e = t - y / mu;
        const double u = U_.segment(b)(i, j) + mu * (l - s);
        const double bound = test::tolerance::by_hand(16);
        EXPECT_NEAR(after.X.segment(b)(i, j), s - U_.segment(b)(i, j) / mu, bound);
        EXPECT_NEAR(after.E.segment(b)(i, j), P_.segment(b)(i, j) * e, bound);
        EXPECT_NEAR(after.Y.segment(b)(i, j), y, bound);
        EXPECT_NEAR(after.U.segment(b)(i, j), u, bound);
        EXPECT_NEAR(after.next.segment(b)(i, j), next * (d - e) + y + next * l + u, bound);
        gap[b] += std::pow(d - s - e, 2);
        split[b] += std::pow(l - s, 2);
      }
  // The first segment has two blocks.
  const double bound = test::tolerance::sum_of_products(301 * 5, 16);
  EXPECT_NEAR(after.gaps[0] + after.gaps[1], gap[0], bound);
  EXPECT_NEAR(after.splits[0] + after.splits[1], split[0], bound);
  EXPECT_NEAR(after.gaps[2], gap[1], bound);
  EXPECT_NEAR(after.splits[2], split[1], bound);
}

TEST_P(GroupTemporalTest, NoBitDependsOnTheSizeOfTheGroup) {
  const Updated after = run(GetParam()), other = run(16);

  EXPECT_TRUE(test::same_bits(after.X, other.X));
  EXPECT_TRUE(test::same_bits(after.E, other.E));
  EXPECT_TRUE(test::same_bits(after.Y, other.Y));
  EXPECT_TRUE(test::same_bits(after.U, other.U));
  EXPECT_TRUE(test::same_bits(after.next, other.next));
  EXPECT_EQ(after.gaps, other.gaps);
  EXPECT_EQ(after.splits, other.splits);
}

TEST_P(GroupTemporalTest, KeepsThePaddingZero) {
  const Updated after = run(GetParam());

  for (const SegmentBatch* part : {&after.X, &after.E, &after.Y, &after.U, &after.next}) {
    const Eigen::Map<const Matrix> rows(part->storage().data(), part->rows(), part->pitch());
    EXPECT_EQ(rows.rightCols(part->pitch() - 5).cwiseAbs().sum(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(WorkGroups, GroupTemporalTest, testing::Values(64, 128, 256),
                         [](const auto& parameter) {
                           return "WG" + std::to_string(parameter.param);
                         });

}  // namespace
}  // namespace moclean
