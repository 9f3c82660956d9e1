#pragma once

#include <Eigen/Core>

namespace moclean::reference {

/// X = U diag(sigma) V', thin: with k = min(rows, columns), U is [rows x k] and V [columns x k].
struct Svd {
  Eigen::MatrixXd u;
  Eigen::VectorXd sigma;  ///< decreasing, >= 0
  Eigen::MatrixXd v;
};

/// Singular value decomposition of X itself, never of X'X.
///
/// The longer side is first reduced by a Householder QR (Chan 1982), the square rest goes to
/// Eigen::BDCSVD. BDCSVD of Eigen 3.4 has had defects, so its result is multiplied out; if it
/// reports failure or U diag(sigma) V' is not X to rounding, the slower Eigen::JacobiSVD decides.
Svd thin_svd(const Eigen::MatrixXd& x);

}  // namespace moclean::reference
