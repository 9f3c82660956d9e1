#pragma once

#include <optional>

#include "moclean/linalg/batch.hpp"

namespace moclean {

/// The products of class Products in their form for GPUs: tiles of work-groups, with slices of the
/// factors in local memory (kernels/products_group.cl). Every sum runs in increasing order, so the
/// results do not depend on the size of the work-group.
template <class Real = double>
class GroupProducts {
 public:
  /// `work_group`: work-items per tile, 16 to 256, rounded down to a power of two and to what the
  /// device can run; throws ArgumentError outside that range.
  explicit GroupProducts(const Device& device, int work_group = 256);

  void gram(const Batch& batch, const Buffer<Real>& x, Buffer<Real>& g, GramOf which = GramOf::all);
  void reconstruct(const Batch& batch, const Buffer<Real>& z, const Buffer<Real>& f,
                   const Buffer<std::int32_t>& terms, Buffer<Real>& w);
  void apply(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& w, Buffer<Real>& a);
  void rotate(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& z, Buffer<Real>& b);
  void compose(const Batch& batch, const Buffer<Real>& p, const Buffer<Real>& z, Buffer<Real>& c);

  int work_group() const { return work_group_; }

 private:
  struct Programs {
    Programs(const Device& device, int work_group);
    std::size_t largest_group() const;

    Program program;
    Kernel gram, reconstruct, apply, rotate, compose;
  };

  Grid tiles(const Batch& batch, Index rows, Index columns) const;
  Grid square_tiles(const Batch& batch) const;
  Grid stacked_tiles(const Batch& batch) const;
  void stacked_product(Kernel& kernel, const Batch& batch, const Buffer<Real>& x,
                       const Buffer<Real>& square, Buffer<Real>& product) const;

  std::optional<Programs> programs_;
  int work_group_;
};

}  // namespace moclean
