#pragma once

#include <span>
#include <vector>

#include "moclean/methods/spectral/singular_value_thresholding.hpp"
#include "moclean/methods/spectral/truncated_svd.hpp"

namespace moclean {

// Methods that keep the singular vectors of D and weigh its singular values: A = U diag(f sigma)
// V'.

/// Weights f_k in [0, 1] for the singular values of a rows x columns matrix, which decrease; they
/// do not increase. Singular values below 1e-7 of the largest count as zero and get the weight 0.
/// Throws ArgumentError if the method has no rule for a matrix of this size.
std::vector<double> weights_of(const TruncatedSvd& method, std::span<const double> sigma,
                               Index rows, Index columns);
std::vector<double> weights_of(const SingularValueThresholding& method,
                               std::span<const double> sigma, Index rows, Index columns);

}  // namespace moclean
