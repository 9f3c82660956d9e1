#pragma once

#include "moclean/core/matrix.hpp"

namespace moclean {

/// Throws ShapeError unless both are [frames x columns] of the same size.
void require_same_shape(const ConstMatrixRef& truth, const ConstMatrixRef& estimate);

/// Throws ShapeError unless the mask has the shape of the samples.
void require_mask_fits(const Mask& mask, const ConstMatrixRef& samples);

}  // namespace moclean
