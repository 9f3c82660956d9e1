#include <gtest/gtest.h>

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/batch.hpp"

#include "support/device.hpp"
#include "support/matrix.hpp"

namespace moclean {
namespace {

// The one kernel the CLBlast path has of its own, tested apart from CLBlast's so that Oclgrind can
// judge it.
TEST(ScaleRows, MultipliesEveryRowOfASquareMatrixByItsWeight) {
  const Device& device = test::device();
  const SegmentBatch shape(5, {0, 3, 12});  // orders 3 and 5
  const Batch batch(device, shape, 0, 2);
  constexpr Index pitch = padded(5);
  constexpr auto size = static_cast<std::size_t>(8 * pitch);
  const Matrix rows = test::random_matrix(8, pitch, 1);
  std::vector<double> weights(batch.vector_size());
  for (std::size_t k = 0; k < weights.size(); ++k) weights[k] = 0.5 * static_cast<double>(k) - 1;
  const Buffer<double> z(device, std::span<const double>(rows.data(), size));
  const Buffer<double> f(device, std::span<const double>(weights));
  Buffer<double> scaled(device, size);
  Matrix result(8, pitch);

  Kernel scale_rows(Program(device, kernel_source::scale_rows, common_defines(device)),
                    "scale_rows");
  scale_rows(Grid{.x = 8, .y = 2}, batch.device_segments(), batch.device_active(), z, f, scaled);
  scaled.read(std::span<double>(result.data(), size));

  for (Index k = 0; k < 8; ++k) {  // rows 0 to 2 are those of segment 0, then 5 of segment 1
    const Index weight = k < 3 ? k : batch.segment(1).vector + k - 3;
    EXPECT_EQ(result.row(k), weights[static_cast<std::size_t>(weight)] * rows.row(k));
  }
}

}  // namespace
}  // namespace moclean
