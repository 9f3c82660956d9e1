#pragma once

#include "moclean/denoise/denoiser.hpp"

namespace moclean {

/// How closely two backends agree on one take.
struct Agreement {
  double low_rank = 0;       ///< |A - A_ref|_F / |A_ref|_F
  double sparse = 0;         ///< |E - E_ref|_F / |E_ref|_F
  int iterations_apart = 0;  ///< largest difference of a segment's iterations
  int ranks_apart = 0;       ///< largest difference of a segment's rank
};

/// Largest relative difference between a backend and the reference that counts as agreement, for
/// runs to the default tolerance 1e-7. A Gram matrix instead of the SVD costs 6e-11 to 3e-10 in A;
/// E is smaller than A and carries A's absolute error.
inline constexpr double low_rank_agreement_bound = 1e-8;
inline constexpr double sparse_agreement_bound = 1e-6;

/// Largest differences that count as agreement.
struct AgreementBounds {
  double low_rank = low_rank_agreement_bound;
  double sparse = sparse_agreement_bound;
  int iterations_apart = 0;
  int ranks_apart = 0;
};

/// Bounds for matrices in single precision, runs to the tolerance 1e-6. Every iteration rounds each
/// entry by 6e-8, and the last ones count: 2e-7 to 6e-7 in A on motion data. E has A's absolute
/// error: 5e-6 to 3e-5 of itself on takes with noise, 7e-4 on a clean one, which leaves E next to
/// nothing. A residual or a singular value next to its threshold may fall on its other side, and
/// one iteration more lets further singular values pass.
inline constexpr AgreementBounds mixed_agreement_bounds{
    .low_rank = 1e-5, .sparse = 1e-2, .iterations_apart = 1, .ranks_apart = 3};

/// tested - reference, 0 where both are NaN: a column without a sample is left by both.
Matrix difference_of(const Matrix& tested, const Matrix& reference);

/// Bounds for matrix-normal smoothing (`auto`): its steps end before they have converged, which
/// amplifies rounding. E is D - A where a sample was rejected, with A's absolute error.
inline constexpr AgreementBounds smoothing_agreement_bounds{.low_rank = 1e-6, .sparse = 1e-4};

/// Compares a result with that of the reference, all segments of the take together.
/// Where a part of the reference is less than a millionth of |A_ref + E_ref|_F, the difference is
/// relative to that instead; 0/0 counts as 0. Throws ShapeError if the shapes or the segments
/// differ.
Agreement agreement(const Denoised& tested, const Denoised& reference);

/// Every difference within its bound.
bool within(const Agreement& agreement, const AgreementBounds& bounds = {});

}  // namespace moclean
