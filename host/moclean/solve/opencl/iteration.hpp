#pragma once

#include <span>
#include <utility>
#include <vector>

#include "moclean/core/parallel.hpp"
#include "moclean/core/segment_batch.hpp"
#include "moclean/linalg/batch.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::opencl {

/// The sum over the blocks of a segment of what a kernel left for every block, in their order.
double sum_of_blocks(const SegmentRecord& segment, std::span<const double> of_blocks);

/// Ends an iteration: counts it for every active segment and notes its residual [segments]. Those
/// that have converged or are out of iterations leave the batch; returns how many.
Index retire(Batch& batch, std::span<const double> residuals, double tolerance, int max_iterations,
             std::vector<SegmentOutcome>& outcomes);

/// Writes value_of(b), [rows x columns], of all segments to a stacked matrix, found by `jobs`
/// threads. `host` has the shape of the batch and keeps what was written.
template <class ValueOf>
void upload(SegmentBatch& host, const ValueOf& value_of, Buffer<double>& target, int jobs = 1) {
  for_each_index(host.segments(), jobs,
                 [&](Index b) { host.segment(b) = value_of(static_cast<std::size_t>(b)); });
  target.write(std::as_const(host).storage());
}

}  // namespace moclean::opencl
