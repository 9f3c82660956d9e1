#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "moclean/linalg/eigensolver.hpp"
#include "moclean/linalg/memory_layout.hpp"
#include "moclean/linalg/products.hpp"
#include "moclean/solve/solution.hpp"

namespace moclean::opencl {

/// Singular value thresholding of the segments of a batch (Cai, Candes, Shen 2010, 2.1): X = U S V'
/// becomes U max(S - tau, 0) V'. By the eigenproblem of the Gram matrix; the host looks at the
/// singular values and asks for the vectors of those above tau only.
///   G = X'X   (XX' for wide segments), Z its eigenvectors in rows, f_k = max(1 - tau / sigma_k,
///   0),
///             W = Z' diag(f) Z, and the result is XW (WX)
class SoftThreshold {
 public:
  struct Memory {
    explicit Memory(MemoryLayout& of);

    Buffer<double> G, Z, W, eigenvalues, f;
    Buffer<std::int32_t> terms;
    std::vector<double> host_eigenvalues, host_f;
    std::vector<std::int32_t> host_terms;
  };

  /// Throws ArgumentError for a tuning out of its range.
  SoftThreshold(const Device& device, const Tuning& tuning);

  /// Bytes of device memory beside Memory for a segment of this size.
  std::uint64_t scratch_of(Index rows, Index columns) const;

  /// |X|_2 of every active segment, 0 of the others; [segments].
  std::vector<double> spectral_norms(const Batch& batch, const Buffer<double>& x, Memory& m);

  /// `result` of the active segments; the rank of each goes to its outcome. `taus` is [segments].
  void operator()(const Batch& batch, const Buffer<double>& x, std::span<const double> taus,
                  Memory& m, std::vector<SegmentOutcome>& outcomes, Buffer<double>& result);

  /// Throws DeviceError if an eigenproblem did not converge since the last call.
  void check(const Batch& batch) { eigen_.check(batch); }

 private:
  void find_values(const Batch& batch, const Buffer<double>& x, Memory& m);

  Products<double> products_;
  Eigensolver eigen_;
};

}  // namespace moclean::opencl
