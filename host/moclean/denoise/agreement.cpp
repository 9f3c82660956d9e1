#include "moclean/denoise/agreement.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

// 0 in the place of NaN.
Matrix present(const Matrix& values) { return values.array().isNaN().select(0, values); }

// Of a part that is next to nothing, rounding of the data is all there is.
double relative(const Matrix& tested, const Matrix& reference, double data_norm) {
  constexpr double least_share = 1e-6;
  const double difference = difference_of(tested, reference).norm();
  if (difference == 0) return 0;
  const double norm = present(reference).norm();
  return difference / (norm > least_share * data_norm ? norm : data_norm);
}

void require_same_shape(const Denoised& tested, const Denoised& reference) {
  const Matrix& a = tested.motion;
  const Matrix& b = reference.motion;
  if (a.rows() != b.rows() || a.cols() != b.cols())
    throw ShapeError(
        fmt::format("cannot compare results of {} frames x {} columns and {} frames x {} columns",
                    a.rows(), a.cols(), b.rows(), b.cols()));
  if (tested.segments.size() != reference.segments.size())
    throw ShapeError(fmt::format("cannot compare results of {} and {} segments",
                                 tested.segments.size(), reference.segments.size()));
}

}  // namespace

Matrix difference_of(const Matrix& tested, const Matrix& reference) {
  const auto both_missing = tested.array().isNaN() && reference.array().isNaN();
  return both_missing.select(0, tested - reference);
}

Agreement agreement(const Denoised& tested, const Denoised& reference) {
  require_same_shape(tested, reference);
  const Matrix& a_ref = reference.motion;
  const Matrix& e_ref = reference.outliers;
  const double data_norm = present(a_ref + e_ref).norm();

  Agreement result;
  result.low_rank = relative(tested.motion, a_ref, data_norm);
  result.sparse = relative(tested.outliers, e_ref, data_norm);
  for (std::size_t s = 0; s < tested.segments.size(); ++s) {
    const SegmentOutcome& own = tested.segments[s].outcome;
    const SegmentOutcome& expected = reference.segments[s].outcome;
    result.iterations_apart =
        std::max(result.iterations_apart, std::abs(own.iterations - expected.iterations));
    result.ranks_apart =
        std::max(result.ranks_apart, std::abs(own.rank.value_or(0) - expected.rank.value_or(0)));
  }
  return result;
}

bool within(const Agreement& agreement, const AgreementBounds& bounds) {
  return agreement.low_rank <= bounds.low_rank && agreement.sparse <= bounds.sparse &&
         agreement.iterations_apart <= bounds.iterations_apart &&
         agreement.ranks_apart <= bounds.ranks_apart;
}

}  // namespace moclean
