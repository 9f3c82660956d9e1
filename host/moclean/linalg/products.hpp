#pragma once

#include <string>
#include <variant>

#include "moclean/linalg/batch.hpp"

namespace moclean {

/// Who computes the matrix products.
enum class ProductPath { own, clblast };

std::string to_string(ProductPath path);

/// Reads `own` or `clblast`; throws ArgumentError for anything else.
ProductPath parse_product_path(const std::string& text);

/// Products of our own kernels (kernels/products.cl).
class OwnProducts {
 public:
  explicit OwnProducts(const Device& device);

  void gram(const Batch& batch, const Buffer<double>& x, Buffer<double>& g);
  void reconstruct(const Batch& batch, const Buffer<double>& z, const Buffer<double>& f,
                   Buffer<double>& w);
  void apply(const Batch& batch, const Buffer<double>& x, const Buffer<double>& w,
             Buffer<double>& a);
  void rotate(const Batch& batch, const Buffer<double>& x, const Buffer<double>& z,
              Buffer<double>& b);
  void compose(const Batch& batch, const Buffer<double>& p, const Buffer<double>& z,
               Buffer<double>& c);

 private:
  const Device* device_;
  int vector_width_;
  Program program_;
  Kernel gram_, reconstruct_, apply_, compose_, basis_;
  Buffer<double> basis_matrices_;
};

/// Products of CLBlast: one batched call per group of segments of equal shape.
class ClblastProducts {
 public:
  explicit ClblastProducts(const Device& device);

  void gram(const Batch& batch, const Buffer<double>& x, Buffer<double>& g);
  void reconstruct(const Batch& batch, const Buffer<double>& z, const Buffer<double>& f,
                   Buffer<double>& w);
  void apply(const Batch& batch, const Buffer<double>& x, const Buffer<double>& w,
             Buffer<double>& a);
  void rotate(const Batch& batch, const Buffer<double>& x, const Buffer<double>& z,
              Buffer<double>& b);
  void compose(const Batch& batch, const Buffer<double>& p, const Buffer<double>& z,
               Buffer<double>& c);

 private:
  const Device* device_;
  Program program_;
  Kernel scale_rows_;
  Buffer<double> scaled_;
};

/// The products of an iteration, for the active segments of a batch. X, A and B are stacked
/// matrices, G, Z, P, C and W are square matrices of size `order`, f is a vector.
///   gram         G = X'X (XX' for a wide segment); at least the upper triangle is written
///   reconstruct  W = sum_k f_k z_k z_k', z_k the rows of Z, f_k >= 0
///   apply        A = XW (WX for a wide segment)
///   rotate       B = XZ' (ZX for a wide segment): X expressed in the rows of Z
///   compose      C = PZ
/// All are enqueued, none waits. The result for a segment does not depend on its neighbours.
class Products {
 public:
  Products(ProductPath path, const Device& device);

  ProductPath path() const { return path_; }

  void gram(const Batch& batch, const Buffer<double>& x, Buffer<double>& g);
  void reconstruct(const Batch& batch, const Buffer<double>& z, const Buffer<double>& f,
                   Buffer<double>& w);
  void apply(const Batch& batch, const Buffer<double>& x, const Buffer<double>& w,
             Buffer<double>& a);
  void rotate(const Batch& batch, const Buffer<double>& x, const Buffer<double>& z,
              Buffer<double>& b);
  void compose(const Batch& batch, const Buffer<double>& p, const Buffer<double>& z,
               Buffer<double>& c);

 private:
  ProductPath path_;
  std::variant<OwnProducts, ClblastProducts> products_;
};

}  // namespace moclean
