#pragma once

#include <algorithm>
#include <bit>
#include <optional>
#include <string>

#include "moclean/linalg/batch.hpp"

namespace moclean {

/// -D options of kernels in work-groups: the common ones and WG.
inline Defines group_defines(const Device& device, int work_group,
                             NumberType type = NumberType::float64) {
  Defines defines = common_defines(device, type);
  defines["WG"] = std::to_string(work_group);
  return defines;
}

/// A work-group per active block of rows.
inline Grid group_per_block(const Batch& batch, int work_group) {
  const auto width = static_cast<std::size_t>(work_group);
  return {.x = width * static_cast<std::size_t>(batch.active_blocks()), .group_x = width};
}

/// A work-item per vector of columns and active segment. On a GPU, whose vectors have one real,
/// neighbours share a group, so that they read neighbouring reals together.
inline Grid per_column(const Batch& batch, const Device& device, NumberType type) {
  constexpr std::size_t warp = 32;
  const int width = vector_width(device, type);
  return {.x = static_cast<std::size_t>(batch.pitch() / width),
          .y = static_cast<std::size_t>(batch.active_count()),
          .group_x = width > 1 ? 1 : std::min(warp, device.info().max_work_group)};
}

/// Builds `programs` for the largest work-group of a power of two up to `wanted` work-items that
/// the device can run all their kernels with, and returns it. `Programs(device, work_group)` builds
/// them, `largest_group()` tells what they can run with.
template <class Programs>
int fit_work_group(std::optional<Programs>& programs, const Device& device, int wanted) {
  auto size = std::bit_floor(
      std::min(static_cast<std::size_t>(std::max(1, wanted)), device.info().max_work_group));
  programs.emplace(device, static_cast<int>(size));
  while (size > 1 && programs->largest_group() < size)
    programs.emplace(device, static_cast<int>(size /= 2));
  return static_cast<int>(size);
}

}  // namespace moclean
