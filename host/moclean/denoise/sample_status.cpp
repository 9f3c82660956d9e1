#include "moclean/denoise/sample_status.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

void require_same_shape(const Recording& take, const Matrix& result, const char* what) {
  const Matrix& samples = take.samples;
  if (samples.rows() == result.rows() && samples.cols() == result.cols()) return;
  throw ShapeError(fmt::format("the {} of a result is {} frames x {} columns, the take {} x {}",
                               what, result.rows(), result.cols(), samples.rows(), samples.cols()));
}

void require_same_shape(const Recording& take, const Denoised& result) {
  require_same_shape(take, result.motion, "motion");
  require_same_shape(take, result.outliers, "outliers");
  if (result.sigma) require_same_shape(take, *result.sigma, "sigma");
  if (result.trusted && (result.trusted->rows() != take.samples.rows() ||
                         result.trusted->cols() != take.samples.cols()))
    throw ShapeError("the trusted samples of a result are not those of the take");
}

// Frames first .. last - 1 of some columns become NaN where `observed` is false.
void clear(Matrix& samples, const Mask& observed, Index first, Index last, const Joint& joint) {
  for (Index f = first; f < last; ++f)
    for (Index c = joint.first_column; c < joint.first_column + joint.columns; ++c)
      if (!observed(f, c)) samples(f, c) = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Mask trusted_samples(const Recording& take, const Denoised& result) {
  require_same_shape(take, result);
  const auto observed = !take.samples.array().isNaN();
  if (result.trusted) return *result.trusted && observed;
  const auto removed = result.outliers.array().abs();
  if (result.sigma) return observed && removed <= result.sigma->array();
  return observed && removed == 0;
}

StatusCounts count_status(const Recording& take, const Denoised& result, const Mask& trusted) {
  const auto given = !result.motion.array().isNaN();
  const auto observed = !take.samples.array().isNaN();
  const Index kept = (given && trusted).count(), filled = (given && !observed).count(),
              all = given.count();
  StatusCounts counts{};
  const auto count = [&](SampleStatus status, Index samples) {
    counts[static_cast<std::size_t>(status)] = samples;
  };
  count(SampleStatus::kept, kept);
  count(SampleStatus::corrected, all - kept - filled);
  count(SampleStatus::filled, filled);
  count(SampleStatus::missing, take.samples.size() - all);
  return counts;
}

Matrix status_numbers(const Recording& take, const Denoised& result, const Mask& trusted) {
  Matrix numbers(take.samples.rows(), take.samples.cols());
  for (Index f = 0; f < numbers.rows(); ++f)
    for (Index c = 0; c < numbers.cols(); ++c) {
      SampleStatus found = SampleStatus::corrected;
      if (std::isnan(result.motion(f, c)))
        found = SampleStatus::missing;
      else if (std::isnan(take.samples(f, c)))
        found = SampleStatus::filled;
      else if (trusted(f, c))
        found = SampleStatus::kept;
      numbers(f, c) = static_cast<double>(found);
    }
  return numbers;
}

void leave_long_gaps(const Recording& take, double seconds, Denoised& result) {
  require_same_shape(take, result);
  if (!(seconds >= 0))
    throw ArgumentError(fmt::format("longest gap is {} s, expected at least 0", seconds));
  if (!(take.frame_rate > 0)) throw ArgumentError("a longest gap in seconds needs the frame rate");

  const Mask observed = !take.samples.array().isNaN();
  for (const Joint& joint : joints(take)) {
    const auto lacks = [&](Index f) {
      return !observed.row(f).segment(joint.first_column, joint.columns).all();
    };
    for (Index first = 0; first < take.frames(); ++first) {
      Index last = first;
      while (last < take.frames() && lacks(last)) ++last;
      if (static_cast<double>(last - first) > seconds * take.frame_rate) {
        clear(result.motion, observed, first, last, joint);
        if (result.sigma) clear(*result.sigma, observed, first, last, joint);
      }
      first = last;
    }
  }
}

void keep_observed(const Recording& take, const Mask& trusted, Denoised& result) {
  result.motion = trusted.select(take.samples, result.motion);
  result.outliers = trusted.select(0, result.outliers);
}

}  // namespace moclean
