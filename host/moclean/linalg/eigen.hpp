#pragma once

#include "moclean/linalg/batch.hpp"

namespace moclean {

/// Eigenproblem of many symmetric matrices of any size (kernels/eigen.cl): Householder
/// tridiagonalisation and implicit QL. Accuracy is that of LAPACK's backward stable solvers:
/// eigenvalues to a few units of rounding times |A|, so the square root of an eigenvalue of a Gram
/// matrix is good to about 1e-8 of the largest. Eigenvalues of a graded matrix (entries that
/// decrease along the diagonal and are that small in their rows and columns, too) are as good
/// relative to themselves.
class SymmetricEigen {
 public:
  explicit SymmetricEigen(const Device& device);

  /// A = Z' diag(values) Z for the active segments. Only the upper triangles of `a` are read; `a`
  /// is destroyed. Row k of Z belongs to values[k]; the values decrease. Does not wait.
  void operator()(const Batch& batch, Buffer<double>& a, Buffer<double>& z, Buffer<double>& values);

  /// Waits, and throws DeviceError if QL gave up on a matrix since the last call (infinite or NaN
  /// entries are the only known cause).
  void check(const Batch& batch);

 private:
  void reserve(const Batch& batch);

  const Device* device_;
  Program program_;
  Kernel kernel_;
  Buffer<double> work_, scratch_;
  Buffer<std::int32_t> failed_;
};

}  // namespace moclean
