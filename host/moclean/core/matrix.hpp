#pragma once

#include <Eigen/Core>

namespace moclean {

/// Count of rows, columns, frames, segments.
using Index = Eigen::Index;

/// Dense row-major matrix of doubles: [frames x columns], a frame is contiguous.
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One claim per entry of a Matrix.
using Mask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Views of a block of rows inside a wider, padded row-major matrix.
using MatrixView = Eigen::Map<Matrix, 0, Eigen::OuterStride<>>;
using ConstMatrixView = Eigen::Map<const Matrix, 0, Eigen::OuterStride<>>;

/// Read-only argument type: accepts a Matrix, a view or a block of rows without a copy.
using ConstMatrixRef = Eigen::Ref<const Matrix, 0, Eigen::OuterStride<>>;

}  // namespace moclean
