#pragma once

#include <cmath>
#include <limits>

#include "moclean/core/matrix.hpp"

/// The one home of tolerances. Every function states why the figure is what it is; a test that
/// needs another one adds a function here and multiplies none.
namespace moclean::test::tolerance {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Absolute error of a few operations on numbers of the given magnitude, as in a calculation on
/// paper: sixteen roundings.
inline double by_hand(double magnitude) { return 16 * epsilon * magnitude; }

/// Absolute error of a sum of `terms` products, each factor pair of at most `magnitude` in product,
/// summed in any order: the classical bound terms x epsilon x the sum of magnitudes.
inline double sum_of_products(Index terms, double magnitude) {
  const auto n = static_cast<double>(terms);
  return n * n * epsilon * magnitude;
}

/// Relative |U S V' - X|_F and departure of U and V from orthogonality for a backward stable
/// decomposition: a small multiple of epsilon times the size, the constant left generous (10)
/// because Householder reductions accumulate one rounding per reflector and column.
inline double decomposition(Index size) { return 10 * epsilon * static_cast<double>(size); }

/// |b - A x| / (|A| |x| + |b|) of a banded system solved by L D L': each entry takes width + 1
/// products in the factor and in each substitution, and the factors of a positive definite matrix
/// are no larger than it is (Higham 2002, theorem 10.3).
inline double band_backward_error(int width) { return 4 * (width + 1) * epsilon; }

/// Absolute error of the solution, of size one, of a banded system with condition number 65 in
/// single precision.
inline double single_precision_bands() { return 65 * 4 * 6e-8; }

/// |GV - V Lambda|_F relative to |G|_F for the batched eigensolvers, orders up to 512: what the
/// project asks of them. Backward stable solvers stay near n^1/2 epsilon, 5e-15 at that size.
inline double eigen_residual() { return 1e-13; }

/// |V'V - I|_F for the batched eigensolvers, orders up to 512: what the project asks of them. V is
/// a product of some n^2 rotations and n reflectors, each orthogonal to a few epsilon.
inline double eigen_orthogonality() { return 1e-12; }

/// Relative Frobenius difference of two runs of robust PCA that differ in rounding only (another
/// order of summation, a transposed or permuted segment). An iteration's rounding error is of the
/// order of `decomposition`; soft thresholds do not amplify it, some 40 iterations add up.
inline double same_iteration(Index size) { return 40 * decomposition(size); }

/// Relative error of A and of E for a planted problem inside the region of exact recovery, solved
/// to the default tolerance 1e-7. The stop bounds D - A - E, not the error of A itself; the rest is
/// the share that passes from E to A within the last iterations, below 100 times the tolerance.
inline double recovery() { return 1e-5; }

/// Relative duality gap of robust PCA at rho = 1.02 and tolerance 1e-7. The method is inexact: the
/// gap shrinks with rho - 1. Measured 1e-7 to 2e-4, against 3e-5 to 9e-4 at rho = 1.5; the bound
/// leaves a factor of 5 and is far below what any mistake in the iteration leaves.
inline double duality_gap() { return 1e-3; }

/// Relative difference of the low-rank parts of two backends at tolerance 1e-7. The Gram matrix
/// squares the condition number but only what lies far above 1/mu survives the threshold; measured
/// 6e-11 to 3e-10 on motion data, the bound leaves a factor of 30.
inline double backends_low_rank() { return 1e-8; }

/// Relative difference of the sparse parts of two backends at tolerance 1e-7. E is one to two
/// orders of magnitude smaller than A and takes over A's absolute error, hence 100 times the bound
/// of A.
inline double backends_sparse() { return 1e-6; }

/// The same two for float matrices at tolerance 1e-6: one rounding of 6e-8 per entry and iteration,
/// the later ones weighing most; measured 3e-7 and 7e-6 on motion data, bounds an order above.
inline double mixed_low_rank() { return 1e-5; }
inline double mixed_sparse() { return 1e-4; }

/// Relative distance of an FD, mean over five seeds, from the figure measured before with another
/// implementation and other seeds: seeds differ by one or two per cent, the bound is twice that.
inline double known_figure() { return 0.04; }

/// Statistic of `samples` independent draws with standard deviation `sd`: five standard errors, a
/// one in two million chance of failing by accident (and never, since the seeds are fixed).
inline double five_standard_errors(double sd, double samples) {
  return 5 * sd / std::sqrt(samples);
}

/// Largest difference, relative to the largest coordinate, from a reader that works in single
/// precision throughout (assimp): about 20 roundings of 6e-8 down a chain of ten joints.
inline double single_precision_reader() { return 1e-5; }

/// The median of the Marchenko-Pastur law by Simpson's rule over 4096 steps, linear in the last.
inline double simpson_median() { return 1e-6; }

/// omega(beta) of Gavish and Donoho's table: their numerical median leaves 1.6e-4 at beta = 1,
/// where there is an exact one.
inline double omega_table() { return 2e-4; }

/// Relative error of a matrix completed to a residual of 1e-4 over seven tenths of its entries: the
/// unseen ones come out worse than the seen ones, by less than an order.
inline double completion() { return 1e-3; }

/// Absolute difference of a filtered sample of magnitude 10 from SciPy's, printed with 15 digits:
/// what the project asks of its filters.
inline double scipy() { return 1e-10; }

/// Relative error of one rounding to single precision.
inline double single_rounding() { return 6e-8; }

/// Relative error of a bone's length where its file prints direction and length with six digits.
inline double printed_digits() { return 5e-6; }

/// Relative difference of the motion of two backends by matrix-normal smoothing. A step stops after
/// ten conjugate gradient iterations, before it has converged, so that rounding is amplified by
/// their condition (up to 1e6) and carried from step to step; 1e-6 is what the project asks.
inline double backends_smoothing() { return 1e-6; }

/// Largest difference, relative to the take's samples, of results that differ in rounding only:
/// another unit, origin, order of joints or direction of time. What the project asks of `auto`.
inline double metamorphic() { return 1e-9; }

/// Relative difference of two formulas for one number (a Schur complement and a block of the
/// inverse, factors built row by row and a dense matrix) in matrices of condition 1e5, the ridge of
/// matrix-normal smoothing.
inline double two_texts() { return 1e-9; }

}  // namespace moclean::test::tolerance
