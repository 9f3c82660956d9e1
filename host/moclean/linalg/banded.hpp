#pragma once

#include "moclean/linalg/batch.hpp"
#include "moclean/linalg/memory_layout.hpp"

namespace moclean {

/// A symmetric band matrix per column and segment, or its factor: band k of the entries (i, i - k)
/// is a stacked matrix, zero for i < k; width + 1 of them one after the other.
template <class Real>
struct ColumnBands {
  Buffer<Real> bands;
};

/// A factor that all columns of a segment share, [rows x (width + 1)].
template <class Real>
struct SharedBands {
  Buffer<Real> bands;
};

/// Symmetric positive definite band systems along time (kernels/linalg/banded.cl): one per column
/// of a segment, its unknowns the rows. The columns of a vector are solved in its lanes; results
/// depend on nothing but the column, bit for bit.
///
/// Delta is the difference of order `width` over the rows of a segment, with free ends; it is empty
/// where a segment has no more rows than that. Whatever is not positive definite, like a column of
/// weights that are all zero, comes out finite but without meaning. None of the functions waits.
template <class Real>
class Banded {
 public:
  /// `width` is 1, 2 or 3; throws ArgumentError otherwise.
  Banded(const Device& device, int width);

  int width() const { return width_; }

  /// Bands for a batch, uninitialised.
  ColumnBands<Real> column_bands(MemoryLayout& of) const {
    return {of.stacked<Real>(Initially::undefined, width_ + 1)};
  }
  SharedBands<Real> shared_bands(MemoryLayout& of) const { return {of.per_row<Real>(width_ + 1)}; }

  /// A_j = diag(W_j) + q_j Delta'Delta for every column j: `weights` W is a stacked matrix with
  /// entries >= 0, `penalties` q >= 0 is [segments x pitch], 0 in the padding.
  void assemble(const Batch& batch, const Buffer<Real>& weights, const Buffer<Real>& penalties,
                ColumnBands<Real>& bands);

  /// A = L D L', in place; the bands hold L and, as band 0, 1 / D from then on.
  void factor(const Batch& batch, ColumnBands<Real>& bands);

  /// The factor of c I + q Delta'Delta for every segment: `weights` c > 0, `penalties` q >= 0, both
  /// [segments].
  void factor(const Batch& batch, const Buffer<Real>& weights, const Buffer<Real>& penalties,
              SharedBands<Real>& bands);

  /// Solves A x = b given the factor of A; b and x are stacked matrices, possibly the same.
  void solve(const Batch& batch, const ColumnBands<Real>& factor, const Buffer<Real>& b,
             Buffer<Real>& x);
  void solve(const Batch& batch, const SharedBands<Real>& factor, const Buffer<Real>& b,
             Buffer<Real>& x);

  /// y = Delta'Delta x, stacked matrices, not the same.
  void penalise(const Batch& batch, const Buffer<Real>& x, Buffer<Real>& y);

 private:
  Grid per_vector(const Batch& batch) const;
  Work solve_work(const Batch& batch, bool shared) const;

  const Device* device_;
  int width_;
  Program program_;
  Kernel assemble_columns_, factor_columns_, solve_columns_, factor_shared_, solve_shared_,
      penalise_;
};

}  // namespace moclean
