#include "moclean/linalg/group_products.hpp"

#include <algorithm>

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work.hpp"
#include "moclean/linalg/work_group.hpp"

namespace moclean {
namespace {

// The tile of a work-group, as kernels/products_group.cl cuts it.
constexpr Index tile_across = 64;
constexpr Index tile_down(int work_group) { return work_group / 4; }

constexpr int least_group = 16, largest_group_size = 256;

int checked(int work_group) {
  if (work_group < least_group || work_group > largest_group_size)
    throw ArgumentError("tiles of products have 16 to 256 work-items, not " +
                        std::to_string(work_group));
  return work_group;
}

std::size_t tiles_over(Index size, Index tile) {
  return static_cast<std::size_t>((size + tile - 1) / tile);
}

}  // namespace

GroupProducts::Programs::Programs(const Device& device, int work_group)
    : program(device, kernel_source::products_group, group_defines(device, work_group)),
      gram(program, "gram"),
      reconstruct(program, "reconstruct"),
      apply(program, "apply"),
      rotate(program, "rotate_into"),
      compose(program, "compose") {}

std::size_t GroupProducts::Programs::largest_group() const {
  return std::min({gram.largest_group(), reconstruct.largest_group(), apply.largest_group(),
                   rotate.largest_group(), compose.largest_group()});
}

GroupProducts::GroupProducts(const Device& device, int work_group)
    : work_group_(fit_work_group(programs_, device, checked(work_group))) {
  if (work_group_ < least_group)
    throw DeviceError("products in work-groups need 16 work-items, " + device.info().name +
                      " can run " + std::to_string(work_group_));
}

Grid GroupProducts::tiles(const Batch& batch, Index rows, Index columns) const {
  const auto width = static_cast<std::size_t>(work_group_);
  return {.x = width * tiles_over(columns, tile_across),
          .y = tiles_over(rows, tile_down(work_group_)),
          .z = static_cast<std::size_t>(batch.active_count()),
          .group_x = width};
}

Grid GroupProducts::square_tiles(const Batch& batch) const {
  return tiles(batch, batch.largest_order_pitch(), batch.largest_order_pitch());
}

// Tiles that cover the longest active segment; a shorter one leaves some without work.
Grid GroupProducts::stacked_tiles(const Batch& batch) const {
  Index rows = 0;
  for (const std::int32_t b : batch.active()) rows = std::max<Index>(rows, batch.segment(b).rows);
  return tiles(batch, rows, batch.segment(0).pitch);
}

void GroupProducts::gram(const Batch& batch, const Buffer<double>& x, Buffer<double>& g, GramOf) {
  const auto work_of = [](std::size_t, const SegmentRecord& segment) { return gram_work(segment); };
  programs_->gram.with([&] { return total_work(batch, work_of); })(
      square_tiles(batch), batch.device_segments(), batch.device_active(), x, g);
}

void GroupProducts::reconstruct(const Batch& batch, const Buffer<double>& z,
                                const Buffer<double>& f, const Buffer<std::int32_t>& terms,
                                Buffer<double>& w) {
  const auto work = [&] {
    const auto counts = host_copy(terms);
    return total_work(batch, [&](std::size_t b, const SegmentRecord& segment) {
      return outer_products_work(segment, counts[b]);
    });
  };
  programs_->reconstruct.with(work)(square_tiles(batch), batch.device_segments(),
                                    batch.device_active(), z, f, terms, w);
}

void GroupProducts::apply(const Batch& batch, const Buffer<double>& x, const Buffer<double>& w,
                          Buffer<double>& a) {
  stacked_product(programs_->apply, batch, x, w, a);
}

void GroupProducts::rotate(const Batch& batch, const Buffer<double>& x, const Buffer<double>& z,
                           Buffer<double>& b) {
  stacked_product(programs_->rotate, batch, x, z, b);
}

// The product of X with a square matrix from one side.
void GroupProducts::stacked_product(Kernel& kernel, const Batch& batch, const Buffer<double>& x,
                                    const Buffer<double>& square, Buffer<double>& product) const {
  const auto work_of = [](std::size_t, const SegmentRecord& segment) {
    return apply_work(segment);
  };
  kernel.with([&] { return total_work(batch, work_of); })(
      stacked_tiles(batch), batch.device_segments(), batch.device_active(), x, square, product);
}

void GroupProducts::compose(const Batch& batch, const Buffer<double>& p, const Buffer<double>& z,
                            Buffer<double>& c) {
  const auto work_of = [](std::size_t, const SegmentRecord& segment) {
    return outer_products_work(segment, segment.order);
  };
  programs_->compose.with([&] { return total_work(batch, work_of); })(
      square_tiles(batch), batch.device_segments(), batch.device_active(), p, z, c);
}

}  // namespace moclean
