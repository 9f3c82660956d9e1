#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "moclean/linalg/batch.hpp"
#include "moclean/linalg/eigen_flags.hpp"

namespace moclean {

/// What a GroupEigen may use of its device; never more than the device has.
struct GroupLimits {
  int work_group = 128;  ///< work-items per matrix; rounded down to a power of two
  std::uint64_t local_memory = std::numeric_limits<std::uint64_t>::max();  ///< bytes per matrix
};

/// The form of SymmetricEigen for GPUs, with the same contract and accuracy: a work-group per
/// matrix (kernels/linalg/tridiagonal_group.cl, eigen_group.cl). Householder tridiagonalisation in
/// local memory where the packed triangle fits, in global memory where not, to the same bits; then
/// implicit QL, whose rotations one work-item computes and all others apply.
///
/// Six vectors of `order` entries have to fit local memory: orders up to 1016 with 48 KiB.
class GroupEigen {
 public:
  /// Throws DeviceError if the device has no double precision.
  explicit GroupEigen(const Device& device, const GroupLimits& limits = {});

  /// A = Z' diag(values) Z for the active segments. Only the upper triangles of `a` are read; `a`
  /// is destroyed. Row k of Z belongs to values[k]; the values decrease; padding is zero. Does not
  /// wait. Throws DeviceError if a matrix is too large for the device's local memory.
  void operator()(const Batch& batch, Buffer<double>& a, Buffer<double>& z, Buffer<double>& values);

  /// The eigenvalues of the active segments with chosen[b] != 0; the others keep what they have,
  /// eigenvalues and what vectors() needs. Unlike SymmetricEigen's, this does the work of the
  /// vectors, too.
  void values(const Batch& batch, const Buffer<std::int32_t>& chosen, Buffer<double>& a,
              Buffer<double>& values);

  /// The same for all active segments.
  void all_values(const Batch& batch, Buffer<double>& a, Buffer<double>& values);

  /// After values(): the eigenvectors of the wanted[b] largest eigenvalues of segment b, in the
  /// leading rows of Z; its other rows stay as they are.
  void vectors(const Batch& batch, const Buffer<std::int32_t>& wanted, Buffer<double>& z);

  /// The same for all eigenvectors.
  void all_vectors(const Batch& batch, Buffer<double>& z);

  /// Waits, and throws DeviceError if QL gave up on a matrix since the last call (infinite or NaN
  /// entries are the only known cause).
  void check(const Batch& batch);

  /// Work-items per matrix on this device.
  int work_group() const { return work_group_; }

  /// Bytes of local memory the reduction of a matrix takes with the triangle in it, and without.
  std::uint64_t local_memory(Index order, bool triangle) const;

  /// Bytes of device memory a matrix of this order takes beside A, Z and its values.
  static std::uint64_t memory_of(Index order);

 private:
  // The reduction is built for either place of the triangle.
  struct Programs {
    Programs(const Device& device, int work_group);
    /// Work-items that every kernel can run with.
    std::size_t largest_group() const;

    Program in_local, in_global, rotation;
    Kernel reduce_in_local, reduce_in_global, accumulate, diagonalise, sort;
  };

  void reserve(const Batch& batch);
  Grid groups(const Batch& batch) const;
  void reduce(const Batch& batch, const Buffer<std::int32_t>& chosen, Buffer<double>& a);

  const Device* device_;
  EigenFlags flags_;
  std::optional<Programs> programs_;
  std::uint64_t local_limit_;
  int work_group_;
  Buffer<double> vectors_, d_, e_, scales_;
  Buffer<std::int32_t> places_;
};

}  // namespace moclean
