#pragma once

#include "moclean/linalg/batch.hpp"
#include "moclean/linalg/eigen_flags.hpp"
#include "moclean/linalg/tuning.hpp"

namespace moclean {

/// Eigenproblem of many symmetric matrices of any size: Householder tridiagonalisation, implicit QL
/// with one matrix to a vector lane, and only the eigenvectors asked for (kernels/tridiagonal.cl,
/// tridiagonal_ql.cl, eigenvectors.cl). Accuracy is that of LAPACK's backward stable solvers:
/// eigenvalues to a few units of rounding times |A|, so the square root of an eigenvalue of a Gram
/// matrix is good to about 1e-8 of the largest. Eigenvalues of a graded matrix (entries that
/// decrease along the diagonal and are that small in their rows and columns, too) are as good
/// relative to themselves.
class SymmetricEigen {
 public:
  /// `panel` as in Tuning. QL drops an off-diagonal of less than `negligible` times the geometric
  /// mean of its neighbours; the default is half a unit of rounding, and larger values take fewer
  /// sweeps: an eighth of the time is saved with 1e-8.
  explicit SymmetricEigen(const Device& device, int panel = Tuning{}.panel,
                          double negligible = rounding);

  /// Half a unit of rounding of double.
  static constexpr double rounding = 1.1102230246251565e-16;

  /// A = Z' diag(values) Z for the active segments. Only the upper triangles of `a` are read; `a`
  /// is destroyed. Row k of Z belongs to values[k]; the values decrease. Does not wait.
  void operator()(const Batch& batch, Buffer<double>& a, Buffer<double>& z, Buffer<double>& values);

  /// The eigenvalues of the active segments with chosen[b] != 0; the others keep what they have,
  /// eigenvalues and what vectors() needs.
  void values(const Batch& batch, const Buffer<std::int32_t>& chosen, Buffer<double>& a,
              Buffer<double>& values);

  /// The same for all active segments.
  void all_values(const Batch& batch, Buffer<double>& a, Buffer<double>& values);

  /// After values(): the eigenvectors of the wanted[b] largest eigenvalues of segment b, in the
  /// leading rows of Z and the leading columns of `a`; the other rows of Z stay as they are.
  void vectors(const Batch& batch, const Buffer<std::int32_t>& wanted, Buffer<double>& a,
               Buffer<double>& z);

  /// The same for all eigenvectors.
  void all_vectors(const Batch& batch, Buffer<double>& a, Buffer<double>& z);

  /// Waits, and throws DeviceError if QL gave up on a matrix since the last call (infinite or NaN
  /// entries are the only known cause).
  void check(const Batch& batch);

  /// Bytes of device memory a matrix of this order takes beside A, Z and its values.
  static std::uint64_t memory_of(Index order);

 private:
  void reserve(const Batch& batch);
  Work reduction_work(const Batch& batch, const Buffer<std::int32_t>& chosen) const;
  Work transformation_work(const Batch& batch, const Buffer<std::int32_t>& wanted) const;

  const Device* device_;
  EigenFlags flags_;
  int vector_width_, panel_;
  Program program_;
  Kernel tridiagonalise_, diagonalise_, transform_;
  Buffer<double> reflectors_, d_, e_, scales_, scratch_, lanes_, rotations_;
  Buffer<std::int32_t> sweeps_, sweep_counts_, places_;
};

}  // namespace moclean
