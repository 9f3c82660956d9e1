#include "moclean/denoise/sample_status.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

void require_same_shape(const Clip& take, const Matrix& result, const char* what) {
  const Matrix& samples = take.samples;
  if (samples.rows() == result.rows() && samples.cols() == result.cols()) return;
  throw ShapeError(fmt::format("the {} of a result is {} frames x {} columns, the take {} x {}",
                               what, result.rows(), result.cols(), samples.rows(), samples.cols()));
}

void require_same_shape(const Clip& take, const Denoised& result) {
  require_same_shape(take, result.clip.samples, "motion");
  require_same_shape(take, result.outliers.samples, "outliers");
  if (result.sigma) require_same_shape(take, result.sigma->samples, "sigma");
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

Mask trusted_samples(const Clip& take, const Denoised& result) {
  require_same_shape(take, result);
  const auto observed = !take.samples.array().isNaN();
  if (result.trusted) return *result.trusted && observed;
  const auto removed = result.outliers.samples.array().abs();
  if (result.sigma) return observed && removed <= result.sigma->samples.array();
  return observed && removed == 0;
}

Clip sample_status(const Clip& take, const Denoised& result) {
  const Mask trusted = trusted_samples(take, result);
  Clip status = take;
  for (Index f = 0; f < take.frames(); ++f)
    for (Index c = 0; c < take.samples.cols(); ++c) {
      SampleStatus found = SampleStatus::corrected;
      if (std::isnan(result.clip.samples(f, c)))
        found = SampleStatus::missing;
      else if (std::isnan(take.samples(f, c)))
        found = SampleStatus::filled;
      else if (trusted(f, c))
        found = SampleStatus::kept;
      status.samples(f, c) = static_cast<double>(found);
    }
  return status;
}

std::array<Index, 4> count_status(const Clip& status) {
  std::array<Index, 4> counts{};
  for (std::size_t s = 0; s < counts.size(); ++s)
    counts[s] = (status.samples.array() == static_cast<double>(s)).count();
  return counts;
}

void leave_long_gaps(const Clip& take, double seconds, Denoised& result) {
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
        clear(result.clip.samples, observed, first, last, joint);
        if (result.sigma) clear(result.sigma->samples, observed, first, last, joint);
      }
      first = last;
    }
  }
}

void keep_observed(const Clip& take, Denoised& result) {
  const Mask trusted = trusted_samples(take, result);
  Matrix& motion = result.clip.samples;
  motion = trusted.select(take.samples.array(), motion.array()).matrix();
  Matrix& outliers = result.outliers.samples;
  outliers = trusted.select(0.0, outliers.array()).matrix();
}

}  // namespace moclean
