#pragma once

#include <optional>

#include "moclean/linalg/eigensolver.hpp"
#include "moclean/linalg/products.hpp"
#include "moclean/methods/robust_pca/opencl_entry_steps.hpp"
#include "moclean/methods/robust_pca/opencl_plan.hpp"

namespace moclean::opencl {

/// The singular values and right singular vectors of X in an iteration of robust PCA, by the
/// eigenproblem of a Gram matrix, and the product with what singular value thresholding makes of
/// them. Gram matrix and eigenproblem are double whatever Real is. In the notation of opencl.cpp;
/// the matrix of an eigenproblem is in V, which takes the vectors in columns.
template <class Real>
class RobustPcaSpectrum {
 public:
  using Memory = RobustPcaMemory<Real>;

  /// `steps` is the program of kernels/robust_pca/robust_pca.cl.
  RobustPcaSpectrum(const Device& device, const Tuning& tuning, const Program& steps);

  /// What decides about the iterations of the active segments.
  IterationSetting setting(const Memory& m) const;

  /// sigma^2 of D, and all vectors if the first iteration is graded.
  void of_data(const Batch& batch, Memory& m, const Iteration& first);

  /// sigma^2 of X, f, and the vectors Z. X is there as a whole where the iteration says so, and for
  /// wide segments.
  void of_shifted(const Batch& batch, Memory& m, const Iteration& now);

  /// A = XW as a whole; not in single precision.
  void apply(const Batch& batch, Memory& m);

  /// What a sweep finds A = XW by.
  Multiplier<Real> multiplier(const Batch& batch, Memory& m, const Iteration& now);

  /// The Gram matrix of the next iteration from those a sweep leaves of its blocks.
  void add_up(const Batch& batch, Memory& m);

  /// As in SymmetricEigen.
  void check(const Batch& batch) { eigen_.check(batch); }
  std::uint64_t memory_of(Index order) const { return eigen_.memory_of(order); }

 private:
  static constexpr bool mixed = Memory::mixed;

  // Of kernels/robust_pca/partial_grams.cl: what a sweep leaves to be summed, and mixed precision.
  struct PartialGrams {
    PartialGrams(const Device& device, const Tuning& tuning);

    Program program;
    Kernel sum, of_floats, of_wide_floats, narrow;
  };

  void gram(const Batch& batch, Memory& m, const Iteration& now);
  void gram_of_floats(const Batch& batch, Memory& m, const Buffer<Real>& wide, bool shifted);
  void sum_partial_grams(const Batch& batch, Memory& m, Buffer<double>& g);
  void threshold(const Batch& batch, Memory& m, const Iteration& now);

  Products<double> products_;
  Eigensolver eigen_;
  std::optional<PartialGrams> partial_grams_;  // where an iteration may be one sweep
  Kernel threshold_;
};

}  // namespace moclean::opencl
