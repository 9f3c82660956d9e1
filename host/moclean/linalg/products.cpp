#include "moclean/linalg/products.hpp"

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work.hpp"

namespace moclean {
namespace {

std::variant<OwnProducts, ClblastProducts, GroupProducts> make_products(const Device& device,
                                                                        const Tuning& tuning) {
  if (tuning.products == ProductPath::clblast) return ClblastProducts(device);
  if (tuning.form == KernelForm::gpu) return GroupProducts(device, tuning.work_group);
  return OwnProducts(device, tuning);
}

}  // namespace

Defines product_defines(const Device& device, NumberType type, const Tuning& tuning) {
  Defines defines = common_defines(device, type);
  defines["TILE_ROWS"] = std::to_string(tuning.tile_rows);
  defines["TILE_VECTORS"] = std::to_string(tuning.tile_vectors);
  return defines;
}

OwnProducts::OwnProducts(const Device& device, const Tuning& tuning)
    : device_(&device),
      tile_rows_(static_cast<std::size_t>(tuning.tile_rows)),
      tile_columns_(static_cast<std::size_t>(tuning.tile_vectors * vector_width(device))),
      program_(device, kernel_source::products,
               product_defines(device, NumberType::float64, tuning)),
      gram_(program_, "gram"),
      reconstruct_(program_, "reconstruct"),
      apply_(program_, "apply"),
      compose_(program_, "compose"),
      basis_(program_, "basis") {}

// Tiles that cover the largest square matrix of the batch; a smaller one leaves some without work.
Grid OwnProducts::square_tiles(const Batch& batch) const {
  const auto order = static_cast<std::size_t>(batch.largest_order_pitch());
  return {.x = (order + tile_columns_ - 1) / tile_columns_,
          .y = (order + tile_rows_ - 1) / tile_rows_,
          .z = static_cast<std::size_t>(batch.active_count())};
}

void OwnProducts::gram(const Batch& batch, const Buffer<double>& x, Buffer<double>& g,
                       GramOf which) {
  const auto work_of = [&](std::size_t, const SegmentRecord& segment) {
    return which == GramOf::all || segment.wide() ? gram_work(segment) : Work{};
  };
  gram_.with([&] { return total_work(batch, work_of); })(
      square_tiles(batch), batch.device_segments(), batch.device_active(),
      cl_int{which == GramOf::wide}, x, g);
}

void OwnProducts::reconstruct(const Batch& batch, const Buffer<double>& z, const Buffer<double>& f,
                              const Buffer<std::int32_t>& terms, Buffer<double>& w) {
  const auto work = [&] {
    const auto counts = host_copy(terms);
    return total_work(batch, [&](std::size_t b, const SegmentRecord& segment) {
      return outer_products_work(segment, counts[b]);
    });
  };
  reconstruct_.with(work)(square_tiles(batch), batch.device_segments(), batch.device_active(), z, f,
                          terms, w);
}

void OwnProducts::apply(const Batch& batch, const Buffer<double>& x, const Buffer<double>& w,
                        Buffer<double>& a) {
  const auto work_of = [](std::size_t, const SegmentRecord& segment) {
    return apply_work(segment);
  };
  apply_.with([&] { return total_work(batch, work_of); })(per_block(batch), batch.device_segments(),
                                                          batch.device_blocks(),
                                                          batch.active_blocks(), x, w, a);
}

void OwnProducts::rotate(const Batch& batch, const Buffer<double>& x, const Buffer<double>& z,
                         Buffer<double>& b) {
  grow(basis_matrices_, *device_, batch.square_size());
  const Grid rows{.x = static_cast<std::size_t>(batch.largest_order_pitch()),
                  .y = static_cast<std::size_t>(batch.active_count())};
  basis_(rows, batch.device_segments(), batch.device_active(), z, basis_matrices_);
  apply(batch, x, basis_matrices_, b);
}

void OwnProducts::compose(const Batch& batch, const Buffer<double>& p, const Buffer<double>& z,
                          Buffer<double>& c) {
  const auto work_of = [](std::size_t, const SegmentRecord& segment) {
    return outer_products_work(segment, segment.order);
  };
  compose_.with([&] { return total_work(batch, work_of); })(
      square_tiles(batch), batch.device_segments(), batch.device_active(), p, z, c);
}

Products::Products(const Device& device, const Tuning& tuning)
    : products_(make_products(device, tuning)) {}

void Products::gram(const Batch& batch, const Buffer<double>& x, Buffer<double>& g, GramOf which) {
  std::visit([&](auto& products) { products.gram(batch, x, g, which); }, products_);
}

void Products::reconstruct(const Batch& batch, const Buffer<double>& z, const Buffer<double>& f,
                           const Buffer<std::int32_t>& terms, Buffer<double>& w) {
  std::visit([&](auto& products) { products.reconstruct(batch, z, f, terms, w); }, products_);
}

void Products::apply(const Batch& batch, const Buffer<double>& x, const Buffer<double>& w,
                     Buffer<double>& a) {
  std::visit([&](auto& products) { products.apply(batch, x, w, a); }, products_);
}

void Products::rotate(const Batch& batch, const Buffer<double>& x, const Buffer<double>& z,
                      Buffer<double>& b) {
  std::visit([&](auto& products) { products.rotate(batch, x, z, b); }, products_);
}

void Products::compose(const Batch& batch, const Buffer<double>& p, const Buffer<double>& z,
                       Buffer<double>& c) {
  std::visit([&](auto& products) { products.compose(batch, p, z, c); }, products_);
}

}  // namespace moclean
