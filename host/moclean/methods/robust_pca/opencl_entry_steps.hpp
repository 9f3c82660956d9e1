#pragma once

#include <optional>
#include <string_view>

#include "moclean/linalg/tuning.hpp"
#include "moclean/methods/robust_pca/opencl_memory.hpp"

namespace moclean::opencl {

/// -D options of the programs that go over chunks of rows (kernels/robust_pca/sweep.cl,
/// kernels/robust_pca/partial_grams.cl).
Defines sweep_defines(const Device& device, NumberType type, const Tuning& tuning);

/// What X is multiplied by in A = XW: W itself, or at low rank V diag(f) Z, of all segments.
template <class Real>
struct Multiplier {
  const Buffer<Real>&W, &V, &Z, &f;
  bool low_rank;  ///< whether any segment may take V diag(f) Z
};

/// The steps of robust PCA that go over the entries of the stacked matrices of a batch, in one of
/// two forms: explicit vectors, a work-item per block of rows, with the products between two
/// eigenproblems in the same sweep (kernels/robust_pca/sweep.cl); or, with KernelForm::gpu, a
/// work-group per block, where every product is a step of its own
/// (kernels/robust_pca/sweep_group.cl).
template <class Real>
class EntrySteps {
 public:
  using Memory = RobustPcaMemory<Real>;

  /// Throws ArgumentError for mixed precision in the GPU form, which there is not.
  EntrySteps(const Device& device, const Tuning& tuning);

  /// Y = dual_scale D, and A = 0.
  void start(const Batch& batch, Memory& m);

  /// X, and E of order ea; of the wide segments, or of all.
  void form(const Batch& batch, Memory& m, GramOf which);

  /// A = XW and all that shrink() does, in the CPU form only. `with_gram`: adds the Gram matrices
  /// of the next X to m.G.
  void sweep(const Batch& batch, Memory& m, const Multiplier<Real>& by, bool with_gram);

  /// E, Y+ and the residual from A. Where entries are missing D becomes A.
  void shrink(const Batch& batch, Memory& m);

  /// E in the place of T.
  void finish(const Batch& batch, Memory& m);

 private:
  struct Programs {
    Programs(const Device& device, std::string_view source, const Defines& defines);
    std::size_t largest_group() const;

    Program program;
    Kernel start, form, shrink, finish;
  };
  struct Sweeps {
    explicit Sweeps(const Program& program);

    Kernel full, low_rank, wide;
  };
  struct GroupPrograms : Programs {
    GroupPrograms(const Device& device, int work_group);
  };

  Programs& programs() { return in_groups_ ? *in_groups_ : *in_vectors_; }
  Grid grid(const Batch& batch) const;

  int work_group_ = 1;
  std::optional<Programs> in_vectors_;
  std::optional<GroupPrograms> in_groups_;
  std::optional<Sweeps> sweeps_;
};

}  // namespace moclean::opencl
