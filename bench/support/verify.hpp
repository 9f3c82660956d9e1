#pragma once

#include <fmt/format.h>

#include "moclean/backend/reference_backend.hpp"

namespace moclean::bench {

/// Empty if `solution` agrees with the reference on the first segment of `data` (the bounds the
/// tests use: 1e-8 for A, 1e-6 for E, equal iterations and rank), else what is wrong. A wrong
/// answer is not worth timing.
inline std::string disagreement(const SegmentBatch& data, const Solution& solution,
                                const RobustPca& method) {
  SegmentBatch first(data.columns(), {0, data.rows(0)});
  first.segment(0) = data.segment(0);
  const Solution expected = ReferenceBackend(1).solve(first, method);
  const auto difference = [](const auto& value, const auto& right) {
    return (value - right).norm() / right.norm();
  };
  const double a = difference(solution.low_rank.segment(0), expected.low_rank.segment(0));
  const double e = difference(solution.sparse.segment(0), expected.sparse.segment(0));
  const SegmentOutcome &tested = solution.segments[0], &right = expected.segments[0];
  if (a <= 1e-8 && e <= 1e-6 && tested.iterations == right.iterations && tested.rank == right.rank)
    return {};
  return fmt::format("differs from the reference: A {:.1e}, E {:.1e}, iterations {}/{}, rank {}/{}",
                     a, e, tested.iterations, right.iterations, tested.rank, right.rank);
}

}  // namespace moclean::bench
