#pragma once

#include <variant>

#include "moclean/methods/matrix_completion/matrix_completion.hpp"
#include "moclean/methods/matrix_normal/matrix_normal.hpp"
#include "moclean/methods/robust_pca/robust_pca.hpp"
#include "moclean/methods/spectral/singular_value_thresholding.hpp"
#include "moclean/methods/spectral/truncated_svd.hpp"
#include "moclean/methods/temporal_robust_pca/temporal_robust_pca.hpp"

namespace moclean {

/// What is computed. A method missing on one backend does not compile (std::visit).
using Method = std::variant<RobustPca, TruncatedSvd, SingularValueThresholding, MatrixCompletion,
                            TemporalRobustPca, MatrixNormal>;

/// Whether a method takes NaN as "not observed"; the others need every sample.
bool accepts_missing(const Method& method);

/// Whether a method uses what is known beside the samples.
bool takes_prior(const Method& method);

/// Whether a method tells which samples it used, and how far it may be off.
bool tells_trust(const Method& method);

}  // namespace moclean
