#include "moclean/linalg/products.hpp"

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work.hpp"

namespace moclean {
namespace {

template <class Real>
std::variant<OwnProducts<Real>, ClblastProducts<Real>, GroupProducts<Real>> make_products(
    const Device& device, const Tuning& tuning) {
  if (tuning.products == ProductPath::clblast) return ClblastProducts<Real>(device);
  if (tuning.form == KernelForm::gpu) return GroupProducts<Real>(device, tuning.work_group);
  return OwnProducts<Real>(device, tuning);
}

}  // namespace

Defines product_defines(const Device& device, NumberType type, const Tuning& tuning) {
  Defines defines = common_defines(device, type);
  defines["TILE_ROWS"] = std::to_string(tuning.tile_rows);
  defines["TILE_VECTORS"] = std::to_string(tuning.tile_vectors);
  return defines;
}

template <class Real>
OwnProducts<Real>::OwnProducts(const Device& device, const Tuning& tuning)
    : device_(&device),
      tile_rows_(static_cast<std::size_t>(tuning.tile_rows)),
      tile_columns_(
          static_cast<std::size_t>(tuning.tile_vectors * vector_width(device, number_type<Real>))),
      program_(device, kernel_source::products, product_defines(device, number_type<Real>, tuning)),
      gram_(program_, "gram"),
      reconstruct_(program_, "reconstruct"),
      apply_(program_, "apply"),
      compose_(program_, "compose"),
      basis_(program_, "basis") {}

// Tiles that cover the largest square matrix of the batch; a smaller one leaves some without work.
template <class Real>
Grid OwnProducts<Real>::square_tiles(const Batch& batch) const {
  const auto order = static_cast<std::size_t>(batch.largest_order_pitch());
  return {.x = (order + tile_columns_ - 1) / tile_columns_,
          .y = (order + tile_rows_ - 1) / tile_rows_,
          .z = static_cast<std::size_t>(batch.active_count())};
}

template <class Real>
void OwnProducts<Real>::gram(const Batch& batch, const Buffer<Real>& x, Buffer<Real>& g,
                             GramOf which) {
  const auto work_of = [&](std::size_t, const SegmentRecord& segment) {
    return which == GramOf::all || segment.wide() ? gram_work(segment, sizeof(Real)) : Work{};
  };
  gram_.with([&] { return total_work(batch, work_of); })(
      square_tiles(batch), batch.device_segments(), batch.device_active(),
      cl_int{which == GramOf::wide}, x, g);
}

template <class Real>
void OwnProducts<Real>::reconstruct(const Batch& batch, const Buffer<Real>& z,
                                    const Buffer<Real>& f, const Buffer<std::int32_t>& terms,
                                    Buffer<Real>& w) {
  const auto work = [&] {
    const auto counts = host_copy(terms);
    return total_work(batch, [&](std::size_t b, const SegmentRecord& segment) {
      return outer_products_work(segment, counts[b], sizeof(Real));
    });
  };
  reconstruct_.with(work)(square_tiles(batch), batch.device_segments(), batch.device_active(), z, f,
                          terms, w);
}

template <class Real>
void OwnProducts<Real>::apply(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& w,
                              Buffer<Real>& a) {
  const auto work_of = [](std::size_t, const SegmentRecord& segment) {
    return apply_work(segment, sizeof(Real));
  };
  apply_.with([&] { return total_work(batch, work_of); })(per_block(batch), batch.device_segments(),
                                                          batch.device_blocks(),
                                                          batch.active_blocks(), x, w, a);
}

template <class Real>
void OwnProducts<Real>::rotate(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& z,
                               Buffer<Real>& b) {
  grow(basis_matrices_, *device_, batch.square_size());
  const Grid rows{.x = static_cast<std::size_t>(batch.largest_order_pitch()),
                  .y = static_cast<std::size_t>(batch.active_count())};
  basis_(rows, batch.device_segments(), batch.device_active(), z, basis_matrices_);
  apply(batch, x, basis_matrices_, b);
}

template <class Real>
void OwnProducts<Real>::compose(const Batch& batch, const Buffer<Real>& p, const Buffer<Real>& z,
                                Buffer<Real>& c) {
  const auto work_of = [](std::size_t, const SegmentRecord& segment) {
    return outer_products_work(segment, segment.order, sizeof(Real));
  };
  compose_.with([&] { return total_work(batch, work_of); })(
      square_tiles(batch), batch.device_segments(), batch.device_active(), p, z, c);
}

template <class Real>
Products<Real>::Products(const Device& device, const Tuning& tuning)
    : products_(make_products<Real>(device, tuning)) {}

template <class Real>
void Products<Real>::gram(const Batch& batch, const Buffer<Real>& x, Buffer<Real>& g,
                          GramOf which) {
  std::visit([&](auto& products) { products.gram(batch, x, g, which); }, products_);
}

template <class Real>
void Products<Real>::reconstruct(const Batch& batch, const Buffer<Real>& z, const Buffer<Real>& f,
                                 const Buffer<std::int32_t>& terms, Buffer<Real>& w) {
  std::visit([&](auto& products) { products.reconstruct(batch, z, f, terms, w); }, products_);
}

template <class Real>
void Products<Real>::apply(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& w,
                           Buffer<Real>& a) {
  std::visit([&](auto& products) { products.apply(batch, x, w, a); }, products_);
}

template <class Real>
void Products<Real>::rotate(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& z,
                            Buffer<Real>& b) {
  std::visit([&](auto& products) { products.rotate(batch, x, z, b); }, products_);
}

template <class Real>
void Products<Real>::compose(const Batch& batch, const Buffer<Real>& p, const Buffer<Real>& z,
                             Buffer<Real>& c) {
  std::visit([&](auto& products) { products.compose(batch, p, z, c); }, products_);
}

template class OwnProducts<double>;
template class OwnProducts<float>;
template class Products<double>;
template class Products<float>;

}  // namespace moclean
