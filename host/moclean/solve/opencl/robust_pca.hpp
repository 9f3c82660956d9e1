#pragma once

#include <functional>
#include <stop_token>

#include "moclean/linalg/eigen.hpp"
#include "moclean/linalg/norms.hpp"
#include "moclean/linalg/products.hpp"
#include "moclean/solve/backend.hpp"

namespace moclean::opencl {

/// Scalars of one segment's iteration; mirrors state_t of kernels/robust_pca.cl.
struct SegmentState {
  double mu = 0;
  double mu_next = 0;
  double mu_max = 0;
  double lambda = 0;
  double dual_scale = 0;
  double residual = 0;
  std::int32_t iterations = 0;
  std::int32_t rank = 0;
  std::int32_t converged = 0;
  std::int32_t order_ea = 0;
};
static_assert(sizeof(SegmentState) == 64);

/// Robust PCA of many segments at once on a device; the steps are those of
/// solve/reference/robust_pca.cpp, in the same order.
class RobustPcaSolver {
 public:
  RobustPcaSolver(const Device& device, ProductPath products);

  /// Bytes of device memory a segment of this size takes.
  static std::uint64_t memory_of(Index rows, Index columns);

  /// Called with the number of segments that finished since the last call.
  using Finished = std::function<void(Index)>;

  /// Solves the segments [first, last) of `data` into the same segments of `solution`.
  void solve(const SegmentBatch& data, Index first, Index last, const RobustPca& method,
             Solution& solution, const Finished& finished, const std::stop_token& stop);

 private:
  struct Memory;

  void start(const Batch& batch, Memory& m, const RobustPca& method);
  void decompose(const Batch& batch, Memory& m, double tau);
  void iterate(const Batch& batch, Memory& m, const RobustPca& method, double tau);

  const Device& device_;
  Products products_;
  SymmetricEigen eigen_;
  Norms norms_;
  Program program_;
  Kernel start_state_, start_, threshold_, shrink_, advance_;
};

}  // namespace moclean::opencl
