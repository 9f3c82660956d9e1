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

template <class Real>
GroupProducts<Real>::Programs::Programs(const Device& device, int work_group)
    : program(device, kernel_source::products_group,
              group_defines(device, work_group, number_type<Real>)),
      gram(program, "gram"),
      reconstruct(program, "reconstruct"),
      apply(program, "apply"),
      rotate(program, "rotate_into"),
      compose(program, "compose") {}

template <class Real>
std::size_t GroupProducts<Real>::Programs::largest_group() const {
  return std::min({gram.largest_group(), reconstruct.largest_group(), apply.largest_group(),
                   rotate.largest_group(), compose.largest_group()});
}

template <class Real>
GroupProducts<Real>::GroupProducts(const Device& device, int work_group)
    : work_group_(fit_work_group(programs_, device, checked(work_group))) {
  if (work_group_ < least_group)
    throw DeviceError("products in work-groups need 16 work-items, " + device.info().name +
                      " can run " + std::to_string(work_group_));
}

template <class Real>
Grid GroupProducts<Real>::tiles(const Batch& batch, Index rows, Index columns) const {
  const auto width = static_cast<std::size_t>(work_group_);
  return {.x = width * tiles_over(columns, tile_across),
          .y = tiles_over(rows, tile_down(work_group_)),
          .z = static_cast<std::size_t>(batch.active_count()),
          .group_x = width};
}

template <class Real>
Grid GroupProducts<Real>::square_tiles(const Batch& batch) const {
  return tiles(batch, batch.largest_order_pitch(), batch.largest_order_pitch());
}

// Tiles that cover the longest active segment; a shorter one leaves some without work.
template <class Real>
Grid GroupProducts<Real>::stacked_tiles(const Batch& batch) const {
  Index rows = 0;
  for (const std::int32_t b : batch.active()) rows = std::max<Index>(rows, batch.segment(b).rows);
  return tiles(batch, rows, batch.segment(0).pitch);
}

template <class Real>
void GroupProducts<Real>::gram(const Batch& batch, const Buffer<Real>& x, Buffer<Real>& g, GramOf) {
  const auto work_of = [](std::size_t, const SegmentRecord& segment) {
    return gram_work(segment, sizeof(Real));
  };
  programs_->gram.with([&] { return total_work(batch, work_of); })(
      square_tiles(batch), batch.device_segments(), batch.device_active(), x, g);
}

template <class Real>
void GroupProducts<Real>::reconstruct(const Batch& batch, const Buffer<Real>& z,
                                      const Buffer<Real>& f, const Buffer<std::int32_t>& terms,
                                      Buffer<Real>& w) {
  const auto work = [&] {
    const auto counts = host_copy(terms);
    return total_work(batch, [&](std::size_t b, const SegmentRecord& segment) {
      return outer_products_work(segment, counts[b], sizeof(Real));
    });
  };
  programs_->reconstruct.with(work)(square_tiles(batch), batch.device_segments(),
                                    batch.device_active(), z, f, terms, w);
}

template <class Real>
void GroupProducts<Real>::apply(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& w,
                                Buffer<Real>& a) {
  stacked_product(programs_->apply, batch, x, w, a);
}

template <class Real>
void GroupProducts<Real>::rotate(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& z,
                                 Buffer<Real>& b) {
  stacked_product(programs_->rotate, batch, x, z, b);
}

// The product of X with a square matrix from one side.
template <class Real>
void GroupProducts<Real>::stacked_product(Kernel& kernel, const Batch& batch, const Buffer<Real>& x,
                                          const Buffer<Real>& square, Buffer<Real>& product) const {
  const auto work_of = [](std::size_t, const SegmentRecord& segment) {
    return apply_work(segment, sizeof(Real));
  };
  kernel.with([&] { return total_work(batch, work_of); })(
      stacked_tiles(batch), batch.device_segments(), batch.device_active(), x, square, product);
}

template <class Real>
void GroupProducts<Real>::compose(const Batch& batch, const Buffer<Real>& p, const Buffer<Real>& z,
                                  Buffer<Real>& c) {
  const auto work_of = [](std::size_t, const SegmentRecord& segment) {
    return outer_products_work(segment, segment.order, sizeof(Real));
  };
  programs_->compose.with([&] { return total_work(batch, work_of); })(
      square_tiles(batch), batch.device_segments(), batch.device_active(), p, z, c);
}

template class GroupProducts<double>;
template class GroupProducts<float>;

}  // namespace moclean
