#pragma once

#include <variant>

#include "moclean/linalg/group_products.hpp"
#include "moclean/linalg/tuning.hpp"

namespace moclean {

/// -D options of the programs that use kernels/tiles.cl.
Defines product_defines(const Device& device, NumberType type = NumberType::float64,
                        const Tuning& tuning = {});

/// Products of our own kernels in the CPU form (kernels/products.cl).
template <class Real = double>
class OwnProducts {
 public:
  explicit OwnProducts(const Device& device, const Tuning& tuning = {});

  void gram(const Batch& batch, const Buffer<Real>& x, Buffer<Real>& g, GramOf which = GramOf::all);
  void reconstruct(const Batch& batch, const Buffer<Real>& z, const Buffer<Real>& f,
                   const Buffer<std::int32_t>& terms, Buffer<Real>& w);
  void apply(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& w, Buffer<Real>& a);
  void rotate(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& z, Buffer<Real>& b);
  void compose(const Batch& batch, const Buffer<Real>& p, const Buffer<Real>& z, Buffer<Real>& c);

 private:
  Grid square_tiles(const Batch& batch) const;

  const Device* device_;
  std::size_t tile_rows_, tile_columns_;
  Program program_;
  Kernel gram_, reconstruct_, apply_, compose_, basis_;
  Buffer<Real> basis_matrices_;
};

/// Products of CLBlast: one batched call per group of segments of equal shape.
template <class Real = double>
class ClblastProducts {
 public:
  explicit ClblastProducts(const Device& device);

  void gram(const Batch& batch, const Buffer<Real>& x, Buffer<Real>& g, GramOf which = GramOf::all);
  void reconstruct(const Batch& batch, const Buffer<Real>& z, const Buffer<Real>& f,
                   const Buffer<std::int32_t>& terms, Buffer<Real>& w);
  void apply(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& w, Buffer<Real>& a);
  void rotate(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& z, Buffer<Real>& b);
  void compose(const Batch& batch, const Buffer<Real>& p, const Buffer<Real>& z, Buffer<Real>& c);

 private:
  const Device* device_;
  Program program_;
  Kernel scale_rows_;
  Buffer<Real> scaled_;
};

/// The products of an iteration, for the active segments of a batch. X, A and B are stacked
/// matrices, G, Z, P, C and W are square matrices of size `order`, f is a vector.
///   gram         G = X'X (XX' for a wide segment); at least the upper triangle is written
///   reconstruct  W = sum_k f_k z_k z_k', z_k the rows of Z, f_k >= 0, over the first terms[b] rows
///                (f is zero past them); W may be left as it is where terms[b] is 0
///   apply        A = XW (WX for a wide segment)
///   rotate       B = XZ' (ZX for a wide segment): X expressed in the rows of Z
///   compose      C = PZ
/// All are enqueued, none waits. The result for a segment does not depend on its neighbours. Real
/// is double or float, of the matrices and of the sums.
template <class Real = double>
class Products {
 public:
  /// Those that `tuning` asks for by its `products` and, of our own, its `form`.
  explicit Products(const Device& device, const Tuning& tuning = {});

  void gram(const Batch& batch, const Buffer<Real>& x, Buffer<Real>& g, GramOf which = GramOf::all);
  void reconstruct(const Batch& batch, const Buffer<Real>& z, const Buffer<Real>& f,
                   const Buffer<std::int32_t>& terms, Buffer<Real>& w);
  void apply(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& w, Buffer<Real>& a);
  void rotate(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& z, Buffer<Real>& b);
  void compose(const Batch& batch, const Buffer<Real>& p, const Buffer<Real>& z, Buffer<Real>& c);

 private:
  std::variant<OwnProducts<Real>, ClblastProducts<Real>, GroupProducts<Real>> products_;
};

}  // namespace moclean
