#pragma once

#include <Eigen/Core>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// How alike joints are expected to accelerate by where they are: the mean over frames of
/// exp(-distance / scale), [joints x joints], scale the median over pairs of their mean distance.
/// Positive semidefinite, 1 on the diagonal. `positions` is [frames x 3 joints] and without NaN; at
/// most 32 of its frames, evenly spread, are looked at.
Matrix nearness_of(const ConstMatrixRef& positions);

/// Q to (1 - share) Q + share P, where P_ij = nearness of the joints of columns i and j times
/// sqrt(Q_ii Q_jj), along the same axis, else 0: what `frames` (1 - share) / share more samples of
/// P would make of it. Only the upper triangle of Q is read; both are written.
void draw_to_nearness(const Matrix& nearness, double share, Eigen::Ref<Matrix> q);

}  // namespace moclean
