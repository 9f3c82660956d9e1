#include "moclean/linalg/tuning.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

void require(const char* name, std::int64_t value, std::int64_t least, std::int64_t most) {
  if (value < least || value > most)
    throw ArgumentError(
        fmt::format("tuning: {} is {}, expected {} to {}", name, value, least, most));
}

/// Each queue has a batch in the cache and a host thread that mostly waits; past four, the batches
/// that share the cache become too small to fill vector lanes.
constexpr int most_default_queues = 4;

}  // namespace

std::string to_string(KernelForm form) { return form == KernelForm::cpu ? "cpu" : "gpu"; }

KernelForm parse_kernel_form(const std::string& text) {
  if (text == "cpu") return KernelForm::cpu;
  if (text == "gpu") return KernelForm::gpu;
  throw ArgumentError("the form of the kernels is cpu or gpu, not '" + text + "'");
}

std::string to_string(ProductPath path) { return path == ProductPath::own ? "own" : "clblast"; }

ProductPath parse_product_path(const std::string& text) {
  if (text == "own") return ProductPath::own;
  if (text == "clblast") return ProductPath::clblast;
  throw ArgumentError("products are own or those of clblast, not '" + text + "'");
}

void check(const Tuning& tuning) {
  require("tile_rows", tuning.tile_rows, 1, 16);
  require("tile_vectors", tuning.tile_vectors, 1, 8);
  require("sweep_rows", tuning.sweep_rows, 1, 256);
  require("panel", tuning.panel, 1, 16);
  require("work_group", tuning.work_group, 16, 256);
  require("batch_segments", tuning.batch_segments, 0, std::numeric_limits<std::int32_t>::max());
  require("queues", tuning.queues, 1, 64);
}

Tuning default_tuning(const DeviceInfo& device) {
  if (device.kind == DeviceKind::gpu)
    return {.form = KernelForm::gpu, .work_group = 64, .eigen = KernelForm::gpu};
  if (device.kind != DeviceKind::cpu) return {};
  return {.queues = std::clamp(device.compute_units, 1, most_default_queues)};
}

bool same_bits(const Tuning& a, const Tuning& b) {
  return a.form == b.form && a.products == b.products && a.eigen == b.eigen;
}

std::string to_string(const Tuning& tuning) {
  return fmt::format(
      "tile {} x {}, sweep {} rows, panel {}, form {}{}, products {}, eigensolver {}, batch {}, "
      "queues {}",
      tuning.tile_rows, tuning.tile_vectors, tuning.sweep_rows, tuning.panel,
      to_string(tuning.form),
      tuning.form == KernelForm::gpu ? fmt::format(" of {}", tuning.work_group) : "",
      to_string(tuning.products), to_string(tuning.eigen),
      tuning.batch_segments > 0 ? std::to_string(tuning.batch_segments) : "any", tuning.queues);
}

}  // namespace moclean
