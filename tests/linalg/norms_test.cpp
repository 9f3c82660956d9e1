#include "moclean/linalg/norms.hpp"

#include <gtest/gtest.h>

#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

constexpr Index columns = 93;

// The last segment has no entry but zero, the one before two blocks of rows.
SegmentBatch data() {
  return test::batch_of({test::random_matrix(1, columns, 1), test::random_matrix(33, columns, 2),
                         test::random_matrix(300, columns, 3), Matrix::Zero(5, columns)});
}

struct Result {
  std::vector<double> frobenius = std::vector<double>(4), largest = std::vector<double>(4);
};

Result norms_of(const SegmentBatch& segments, const Tuning& tuning) {
  const Device& device = test::device();
  const Batch batch(device, segments, 0, 4);
  const Buffer<double> x(device, segments.storage());
  Buffer<double> frobenius(device, 4), largest(device, 4);
  Result result;

  Norms<double> norms(device, tuning);
  norms(batch, x, frobenius, largest);
  frobenius.read(result.frobenius);
  largest.read(result.largest);
  return result;
}

void expect_norms(const Result& result, const SegmentBatch& segments) {
  for (Index b = 0; b < 4; ++b) {
    const auto i = static_cast<std::size_t>(b);
    const double expected = segments.segment(b).norm();
    EXPECT_NEAR(result.frobenius[i], expected, test::tolerance::decomposition(columns) * expected);
    EXPECT_EQ(result.largest[i], segments.segment(b).cwiseAbs().maxCoeff());
  }
}

TEST(Norms, AreThoseOfEverySegment) { expect_norms(norms_of(data(), {}), data()); }

class GroupNorms : public testing::TestWithParam<int> {
 protected:
  static Tuning tuning(int work_group) {
    return {.form = KernelForm::gpu, .work_group = work_group};
  }
};

TEST_P(GroupNorms, AreThoseOfEverySegment) {
  expect_norms(norms_of(data(), tuning(GetParam())), data());
}

TEST_P(GroupNorms, NoBitDependsOnTheSizeOfTheGroup) {
  const Result result = norms_of(data(), tuning(GetParam())), other = norms_of(data(), tuning(16));

  EXPECT_EQ(result.frobenius, other.frobenius);
  EXPECT_EQ(result.largest, other.largest);
}

INSTANTIATE_TEST_SUITE_P(WorkGroups, GroupNorms, testing::Values(64, 128, 256),
                         [](const auto& parameter) {
                           return "WG" + std::to_string(parameter.param);
                         });

}  // namespace
}  // namespace moclean
