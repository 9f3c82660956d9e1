#pragma once

#include <optional>

#include "moclean/linalg/memory_layout.hpp"
#include "moclean/linalg/products.hpp"

namespace moclean::opencl {

/// What the conjugate gradients of a batch work on, in the notation of
/// kernels/conjugate_gradients.cl. Stacked matrices are [rows x columns], R is square, precisions
/// are one per row of all segments, 0 of the last two of each, stiffness is the diagonal of R,
/// least what keeps the preconditioner of a segment definite.
struct ConjugateGradientsMemory {
  /// Sums over columns are kept per `vector_width` of them.
  ConjugateGradientsMemory(MemoryLayout& of, KernelForm form, int vector_width);

  Buffer<double> D, W, S, r, z, p, p_before, product, inverse_pivot, first_band;
  Buffer<double> R, precisions, stiffness, least;
  Buffer<double> rz, rz_before, bz, partial_pq;
  Buffer<double> curvatures;  ///< Delta'P Delta p: a chunk per block, in the GPU form all of it
  Buffer<std::int32_t> iterations;  ///< of each segment, counted on
};

/// Preconditioned conjugate gradients for S = argmin sum W (D - S)^2 + tr(P Delta S R (Delta S)')
/// of the segments of a batch, none of them wide. A search direction and its product are found by
/// register tiles, a work-item per block of rows (kernels/search_direction.cl), or with
/// KernelForm::gpu by work-groups (kernels/search_direction_group.cl).
class ConjugateGradients {
 public:
  using Memory = ConjugateGradientsMemory;

  ConjugateGradients(const Device& device, const Tuning& tuning);

  Memory memory(MemoryLayout& of) const;

  /// From m.S on to m.S: at most `most_iterations`, of each segment until the square of its
  /// gradient, as the preconditioner measures it, is `tolerance`^2 of that at S = 0. Work-groups
  /// leave the product with R to `products`.
  void operator()(const Batch& batch, Memory& m, Products<double>& products, int most_iterations,
                  double tolerance);

 private:
  // A work-item per block of rows.
  struct InTiles {
    InTiles(const Device& device, const Tuning& tuning);

    Program program;
    Kernel direction;
  };

  // A work-group per block of rows.
  struct InGroups {
    InGroups(const Device& device, int work_group);
    std::size_t largest_group() const;

    Program program;
    Kernel differences, complete;
  };

  void search_in_tiles(const Batch& batch, Memory& m, const Buffer<double>& z, double tolerance,
                       bool begins);
  void search_in_groups(const Batch& batch, Memory& m, Products<double>& products,
                        const Buffer<double>& z, double tolerance, bool begins);

  const Device& device_;
  Program program_;
  Kernel factor_, start_, update_;
  std::optional<InTiles> tiles_;
  std::optional<InGroups> groups_;
  int work_group_ = 1;
};

}  // namespace moclean::opencl
