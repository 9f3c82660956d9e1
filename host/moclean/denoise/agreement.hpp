#pragma once

#include "moclean/denoise/denoiser.hpp"

namespace moclean {

/// How closely two backends agree on one take.
struct Agreement {
  double low_rank = 0;  ///< |A - A_ref|_F / |A_ref|_F
  double sparse = 0;    ///< |E - E_ref|_F / |E_ref|_F
  bool same_iterations = true;
  bool same_rank = true;
};

/// Largest relative difference between a backend and the reference that counts as agreement, for
/// runs to the default tolerance 1e-7. A Gram matrix instead of the SVD costs 6e-11 to 3e-10 in A;
/// E is smaller than A and carries A's absolute error.
inline constexpr double low_rank_agreement_bound = 1e-8;
inline constexpr double sparse_agreement_bound = 1e-6;

/// Compares a result with that of the reference, all segments of the take together.
/// Where a part of the reference is zero, the difference is relative to |A_ref + E_ref|_F instead;
/// 0/0 counts as 0. Throws ShapeError if the shapes or the segments differ.
Agreement agreement(const Denoised& tested, const Denoised& reference);

/// Both differences within their bounds; equal iterations and equal rank in every segment.
bool within(const Agreement& agreement);

}  // namespace moclean
