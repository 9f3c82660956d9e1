// Splits a small matrix, constant but for one gross error, into both parts; exits 0 if that worked.

#include <cmath>
#include <cstdio>

#include <moclean/denoise/low_rank.hpp>
#include <moclean/formats/read_write.hpp>
#include <moclean/solve/opencl/opencl_backend.hpp>
#include <moclean/solve/reference/reference_backend.hpp>

int main() {
  moclean::SegmentBatch data(6, {0, 20});
  data.segment(0).setConstant(3);
  data.segment(0)(7, 2) += 50;

  moclean::ReferenceBackend backend;
  const moclean::Solution solution = backend.solve(data, moclean::RobustPca{});

  const double cleaned = solution.low_rank.segment(0)(7, 2);
  const double error = solution.sparse.segment(0)(7, 2);
  std::printf("%g = %g + %g, rank %d\n", 53.0, cleaned, error,
              solution.segments[0].rank.value_or(0));
  return std::abs(cleaned - 3) < 1e-4 && std::abs(error - 50) < 1e-4 ? 0 : 1;
}
