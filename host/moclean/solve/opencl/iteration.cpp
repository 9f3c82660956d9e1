#include "moclean/solve/opencl/iteration.hpp"

namespace moclean::opencl {

double sum_of_blocks(const SegmentRecord& segment, std::span<const double> of_blocks) {
  const int blocks = (segment.rows + block_rows - 1) / block_rows;
  double sum = 0;
  for (int block = 0; block < blocks; ++block)
    sum += of_blocks[static_cast<std::size_t>(segment.first_block + block)];
  return sum;
}

Index retire(Batch& batch, std::span<const double> residuals, double tolerance, int max_iterations,
             std::vector<SegmentOutcome>& outcomes) {
  std::vector<std::int32_t> remaining;
  for (const std::int32_t b : batch.active()) {
    SegmentOutcome& outcome = outcomes[static_cast<std::size_t>(b)];
    ++outcome.iterations;
    outcome.residual = residuals[static_cast<std::size_t>(b)];
    outcome.converged = outcome.residual <= tolerance;
    if (!outcome.converged && outcome.iterations < max_iterations) remaining.push_back(b);
  }
  const Index done = batch.active_count() - static_cast<Index>(remaining.size());
  if (done > 0) batch.select(remaining);
  return done;
}

}  // namespace moclean::opencl
