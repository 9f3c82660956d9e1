#pragma once

#include <optional>

#include "moclean/linalg/batch.hpp"
#include "moclean/linalg/tuning.hpp"

namespace moclean {

/// Norms of the active segments of a stacked matrix of Real, each summed in an order that depends
/// on the segment alone: by a work-item per block of rows (kernels/linalg/norms.cl), or with
/// KernelForm::gpu by a work-group (kernels/linalg/norms_group.cl).
template <class Real>
class Norms {
 public:
  explicit Norms(const Device& device, const Tuning& tuning = {});

  /// frobenius[b] = |X_b|_F and largest[b] = max |X_b,ij|; one entry per segment. Does not wait.
  void operator()(const Batch& batch, const Buffer<Real>& x, Buffer<double>& frobenius,
                  Buffer<double>& largest);

 private:
  struct InGroups {
    InGroups(const Device& device, int work_group);
    std::size_t largest_group() const { return block_norms.largest_group(); }

    Program program;
    Kernel block_norms;
  };

  const Device* device_;
  Program program_;
  Kernel block_norms_, segment_norms_;
  std::optional<InGroups> in_groups_;
  int work_group_ = 1;
  Buffer<double> partial_squares_, partial_largest_;
};

}  // namespace moclean
