#include "moclean/linalg/products.hpp"

#include "moclean/device/kernel_source.hpp"

namespace moclean {
namespace {

constexpr int tile_rows = 8;
constexpr int tile_vectors = 3;

Defines product_defines(const Device& device) {
  Defines defines = common_defines(device);
  defines["TILE_ROWS"] = std::to_string(tile_rows);
  defines["TILE_VECTORS"] = std::to_string(tile_vectors);
  return defines;
}

// Tiles that cover the largest square matrix of the batch; a smaller one leaves some without work.
Grid square_tiles(const Batch& batch, int vector_width) {
  const auto order = static_cast<std::size_t>(batch.largest_order_pitch());
  const auto columns = static_cast<std::size_t>(tile_vectors * vector_width);
  return {.x = (order + columns - 1) / columns,
          .y = (order + tile_rows - 1) / tile_rows,
          .z = static_cast<std::size_t>(batch.active_count())};
}

std::variant<OwnProducts, ClblastProducts> make_products(ProductPath path, const Device& device) {
  if (path == ProductPath::clblast) return ClblastProducts(device);
  return OwnProducts(device);
}

}  // namespace

std::string to_string(ProductPath path) { return path == ProductPath::own ? "own" : "clblast"; }

ProductPath parse_product_path(const std::string& text) {
  if (text == "own") return ProductPath::own;
  if (text == "clblast") return ProductPath::clblast;
  throw ArgumentError("products are computed by own or clblast, not by '" + text + "'");
}

OwnProducts::OwnProducts(const Device& device)
    : device_(&device),
      vector_width_(vector_width(device)),
      program_(device, kernel_source::products, product_defines(device)),
      gram_(program_, "gram"),
      reconstruct_(program_, "reconstruct"),
      apply_(program_, "apply"),
      compose_(program_, "compose"),
      basis_(program_, "basis") {}

void OwnProducts::gram(const Batch& batch, const Buffer<double>& x, Buffer<double>& g) {
  gram_(square_tiles(batch, vector_width_), batch.device_segments(), batch.device_active(), x, g);
}

void OwnProducts::reconstruct(const Batch& batch, const Buffer<double>& z, const Buffer<double>& f,
                              Buffer<double>& w) {
  reconstruct_(square_tiles(batch, vector_width_), batch.device_segments(), batch.device_active(),
               z, f, w);
}

void OwnProducts::apply(const Batch& batch, const Buffer<double>& x, const Buffer<double>& w,
                        Buffer<double>& a) {
  apply_(per_block(batch), batch.device_segments(), batch.device_blocks(), batch.active_blocks(), x,
         w, a);
}

void OwnProducts::rotate(const Batch& batch, const Buffer<double>& x, const Buffer<double>& z,
                         Buffer<double>& b) {
  if (basis_matrices_.size() < batch.square_size())
    basis_matrices_ = Buffer<double>(*device_, batch.square_size());
  const Grid rows{.x = static_cast<std::size_t>(batch.largest_order_pitch()),
                  .y = static_cast<std::size_t>(batch.active_count())};
  basis_(rows, batch.device_segments(), batch.device_active(), z, basis_matrices_);
  apply(batch, x, basis_matrices_, b);
}

void OwnProducts::compose(const Batch& batch, const Buffer<double>& p, const Buffer<double>& z,
                          Buffer<double>& c) {
  compose_(square_tiles(batch, vector_width_), batch.device_segments(), batch.device_active(), p, z,
           c);
}

Products::Products(ProductPath path, const Device& device)
    : path_(path), products_(make_products(path, device)) {}

void Products::gram(const Batch& batch, const Buffer<double>& x, Buffer<double>& g) {
  std::visit([&](auto& products) { products.gram(batch, x, g); }, products_);
}

void Products::reconstruct(const Batch& batch, const Buffer<double>& z, const Buffer<double>& f,
                           Buffer<double>& w) {
  std::visit([&](auto& products) { products.reconstruct(batch, z, f, w); }, products_);
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
