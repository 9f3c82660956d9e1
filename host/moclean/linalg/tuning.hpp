#pragma once

#include <cstdint>
#include <string>

#include "moclean/device/device.hpp"

namespace moclean {

/// Which of the two forms of our kernels runs, for all but the eigensolver. `cpu`: one work-item
/// does what fills a core, in explicit vectors; `gpu`: a work-group shares it (docs/gpu.md).
enum class KernelForm { cpu, gpu };

std::string to_string(KernelForm form);

/// Reads `cpu` or `gpu`; throws ArgumentError for anything else.
KernelForm parse_kernel_form(const std::string& text);

/// Whose matrix products: those of our kernels, in the form chosen, or those of CLBlast.
enum class ProductPath { own, clblast };

std::string to_string(ProductPath path);

/// Reads `own` or `clblast`; throws ArgumentError for anything else.
ProductPath parse_product_path(const std::string& text);

/// Choices that make the solver faster or slower on a device. The defaults are those of a CPU.
///
/// tile_rows, tile_vectors, sweep_rows, panel, work_group, batch_segments and queues leave every
/// bit of A and E as it is: each entry is summed in the same order whatever their values. Only the
/// reported residual, a sum over tiles, may change in its last digits. form, products and eigen
/// round differently; results agree within the bounds of moclean/denoise/agreement.hpp.
struct Tuning {
  int tile_rows = 8;     ///< of a register tile, 1 .. 16
  int tile_vectors = 3;  ///< across a register tile, 1 .. 8
  /// Rows from the product A = XW of a sweep to their part of the Gram matrix, 1 .. 256: with the
  /// columns of W, 32 rows fill a first-level cache of 32 KiB.
  int sweep_rows = 32;
  /// Vectors of columns of the eigenvectors that one work-item transforms (CPU form only), 1 .. 16:
  /// 4 x 8 columns of 93 rows fill three quarters of that cache.
  int panel = 4;
  KernelForm form = KernelForm::cpu;
  ProductPath products = ProductPath::own;
  /// Work-items of a work-group of the GPU form, 16 .. 256: rounded down to a power of two and to
  /// what the device can run.
  int work_group = 256;
  /// Of the eigensolver: matrices in the lanes of vectors (SymmetricEigen), or a work-group per
  /// matrix (GroupEigen).
  KernelForm eigen = KernelForm::cpu;
  /// Most segments of a batch, as far as they fit the memory; 0: as many as suit the device's
  /// memory and, on a CPU, its cache.
  std::int64_t batch_segments = 0;
  /// Most batches at the same time, each with a command queue and a thread of its own, 1 .. 64.
  int queues = 1;

  bool operator==(const Tuning&) const = default;
};

/// Throws ArgumentError naming the first choice out of its range.
void check(const Tuning& tuning);

/// What is sound on a device before anything was measured: on a GPU the forms for it, of the
/// eigensolver too, and one queue; on a CPU a queue per compute unit, up to four.
Tuning default_tuning(const DeviceInfo& device);

/// Whether two tunings give the same bits of A and E: the same form, products and
/// form of the eigensolver.
bool same_bits(const Tuning& a, const Tuning& b);

/// One line: `tile 8 x 3, sweep 32 rows, panel 4, form cpu, products own, eigensolver cpu, batch
/// any, queues 2`.
std::string to_string(const Tuning& tuning);

}  // namespace moclean
