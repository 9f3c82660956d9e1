#pragma once

#include "moclean/linalg/batch.hpp"

namespace moclean {

/// Norms of the active segments of a stacked matrix of Real (kernels/norms.cl), each summed in an
/// order that depends on the segment alone.
template <class Real>
class Norms {
 public:
  explicit Norms(const Device& device);

  /// frobenius[b] = |X_b|_F and largest[b] = max |X_b,ij|; one entry per segment. Does not wait.
  void operator()(const Batch& batch, const Buffer<Real>& x, Buffer<double>& frobenius,
                  Buffer<double>& largest);

 private:
  const Device* device_;
  Program program_;
  Kernel block_norms_, segment_norms_;
  Buffer<double> partial_squares_, partial_largest_;
};

}  // namespace moclean
