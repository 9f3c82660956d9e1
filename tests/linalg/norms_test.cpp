#include "moclean/linalg/norms.hpp"

#include <gtest/gtest.h>

#include "support/device.hpp"
#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

TEST(Norms, AreThoseOfEverySegment) {
  const SegmentBatch data = test::batch_of(
      {test::random_matrix(1, 93, 1), test::random_matrix(33, 93, 2), Matrix::Zero(5, 93)});
  const Device& device = test::device();
  const Batch batch(device, data, 0, 3);
  const Buffer<double> x(device, data.storage());
  Buffer<double> frobenius(device, 3), largest(device, 3);
  std::vector<double> f(3), l(3);

  Norms<double> norms(device);
  norms(batch, x, frobenius, largest);
  frobenius.read(f);
  largest.read(l);

  for (Index b = 0; b < 3; ++b) {
    const double expected = data.segment(b).norm();
    EXPECT_NEAR(f[static_cast<std::size_t>(b)], expected,
                test::tolerance::decomposition(93) * expected);
    EXPECT_EQ(l[static_cast<std::size_t>(b)], data.segment(b).cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace moclean
