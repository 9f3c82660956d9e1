#include "moclean/metric/same_shape.hpp"

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {

void require_same_shape(const ConstMatrixRef& truth, const ConstMatrixRef& estimate) {
  if (truth.rows() != estimate.rows() || truth.cols() != estimate.cols())
    throw ShapeError(fmt::format(
        "cannot compare {} frames x {} columns with {} frames x {} columns: the shapes differ",
        truth.rows(), truth.cols(), estimate.rows(), estimate.cols()));
}

void require_mask_fits(const Mask& mask, const ConstMatrixRef& samples) {
  if (mask.rows() != samples.rows() || mask.cols() != samples.cols())
    throw ShapeError(fmt::format(
        "the mask of {} frames x {} columns does not fit a clip of {} frames x {} columns",
        mask.rows(), mask.cols(), samples.rows(), samples.cols()));
}

}  // namespace moclean
