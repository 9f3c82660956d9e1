#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include <clblast.h>
#include <fmt/format.h>

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/products.hpp"

namespace moclean {
namespace {

using clblast::Transpose;

/// Offsets of the operands of equally shaped products: one batched call.
struct Offsets {
  std::vector<std::size_t> left, right, result;
};

/// Rows, then order: segments that agree in both share a call.
using Shape = std::pair<int, int>;

template <class OffsetsOf>
std::map<Shape, Offsets> group_by_shape(const Batch& batch, OffsetsOf&& offsets_of) {
  std::map<Shape, Offsets> groups;
  for (const std::int32_t b : batch.active()) {
    const SegmentRecord& segment = batch.segment(b);
    const auto [left, right, result] = offsets_of(segment);
    Offsets& group = groups[{segment.rows, segment.order}];
    group.left.push_back(left);
    group.right.push_back(right);
    group.result.push_back(result);
  }
  return groups;
}

/// Sizes of C [m x n] = op(A) [m x k] op(B) [k x n] and the pitches of the three.
struct Sizes {
  std::size_t m, n, k, left_pitch, right_pitch, result_pitch;
};

[[noreturn]] void fail(clblast::StatusCode status, const std::string& call, const Device& device) {
  throw DeviceError(fmt::format("CLBlast failed in {} on {}: {}", call, device.info().name,
                                opencl_status(static_cast<cl_int>(status))));
}

// CLBlast fills the table of its tuning parameters at the first call of a process, and does not
// lock it (Database::Database, 1.5.3), but queues begin to multiply at the same time. This call
// comes before all of theirs.
void fill_parameter_table(const Device& device) {
  static std::once_flag filled;
  std::call_once(filled, [&] {
    std::unordered_map<std::string, std::size_t> parameters;
    const auto status = clblast::RetrieveParameters(device.handle()(), "Xgemm",
                                                    clblast::Precision::kDouble, parameters);
    if (status != clblast::StatusCode::kSuccess) fail(status, "its table of parameters", device);
  });
}

template <class Real>
void gemm(const Device& device, Transpose left_form, Transpose right_form, const Sizes& sizes,
          const Offsets& offsets, const Buffer<Real>& left, const Buffer<Real>& right,
          Buffer<Real>& result) {
  const std::size_t count = offsets.left.size();
  const std::vector<Real> one(count, 1), zero(count, 0);
  cl_command_queue queue = device.queue()();
  const auto status = clblast::GemmBatched<Real>(
      clblast::Layout::kRowMajor, left_form, right_form, sizes.m, sizes.n, sizes.k, one.data(),
      left.memory()(), offsets.left.data(), sizes.left_pitch, right.memory()(),
      offsets.right.data(), sizes.right_pitch, zero.data(), result.memory()(),
      offsets.result.data(), sizes.result_pitch, count, &queue, nullptr);
  if (status != clblast::StatusCode::kSuccess)
    fail(status, fmt::format("a batched product {} x {} x {}", sizes.m, sizes.n, sizes.k), device);
}

std::size_t stacked_offset(const SegmentRecord& segment) {
  return static_cast<std::size_t>(segment.first_row * segment.pitch);
}

std::size_t square_offset(const SegmentRecord& segment) {
  return static_cast<std::size_t>(segment.square);
}

// XM, or X op(M) with the given form, for a tall segment; always MX for a wide one.
template <class Real>
void multiply(const Device& device, const Batch& batch, const Buffer<Real>& x,
              const Buffer<Real>& m, Transpose tall_form, Buffer<Real>& result) {
  const auto groups = group_by_shape(batch, [](const SegmentRecord& s) {
    return s.wide() ? std::tuple(square_offset(s), stacked_offset(s), stacked_offset(s))
                    : std::tuple(stacked_offset(s), square_offset(s), stacked_offset(s));
  });
  const auto pitch = static_cast<std::size_t>(batch.segment(0).pitch);
  const auto columns = static_cast<std::size_t>(batch.segment(0).columns);
  for (const auto& [shape, offsets] : groups) {
    const auto rows = static_cast<std::size_t>(shape.first);
    const auto order = static_cast<std::size_t>(shape.second);
    const auto order_pitch = static_cast<std::size_t>(padded(shape.second));
    const bool wide = rows < columns;
    const Sizes sizes{rows, columns, order, wide ? order_pitch : pitch, pitch, pitch};
    if (wide)
      gemm(device, Transpose::kNo, Transpose::kNo, sizes, offsets, m, x, result);
    else
      gemm(device, Transpose::kNo, tall_form, sizes, offsets, x, m, result);
  }
}

// C = op(P) Z of the square matrices.
template <class Real>
void square_product(const Device& device, const Batch& batch, Transpose form, const Buffer<Real>& p,
                    const Buffer<Real>& z, Buffer<Real>& c) {
  const auto groups = group_by_shape(batch, [](const SegmentRecord& s) {
    return std::tuple(square_offset(s), square_offset(s), square_offset(s));
  });
  for (const auto& [shape, offsets] : groups) {
    const auto order = static_cast<std::size_t>(shape.second);
    const auto pitch = static_cast<std::size_t>(padded(shape.second));
    gemm(device, form, Transpose::kNo, {order, order, order, pitch, pitch, pitch}, offsets, p, z,
         c);
  }
}

}  // namespace

template <class Real>
ClblastProducts<Real>::ClblastProducts(const Device& device)
    : device_(&device),
      program_(device, kernel_source::scale_rows, common_defines(device, number_type<Real>)),
      scale_rows_(program_, "scale_rows") {
  fill_parameter_table(device);
}

template <class Real>
void ClblastProducts<Real>::gram(const Batch& batch, const Buffer<Real>& x, Buffer<Real>& g,
                                 GramOf) {
  const auto groups = group_by_shape(batch, [](const SegmentRecord& s) {
    return std::tuple(stacked_offset(s), stacked_offset(s), square_offset(s));
  });
  const auto pitch = static_cast<std::size_t>(batch.segment(0).pitch);
  const int columns = batch.segment(0).columns;
  for (const auto& [shape, offsets] : groups) {
    const bool wide = shape.first < columns;
    const auto order = static_cast<std::size_t>(shape.second);
    const auto depth = static_cast<std::size_t>(wide ? columns : shape.first);
    gemm(*device_, wide ? Transpose::kNo : Transpose::kYes, wide ? Transpose::kYes : Transpose::kNo,
         {order, order, depth, pitch, pitch, static_cast<std::size_t>(padded(shape.second))},
         offsets, x, x, g);
  }
}

template <class Real>
void ClblastProducts<Real>::reconstruct(const Batch& batch, const Buffer<Real>& z,
                                        const Buffer<Real>& f, const Buffer<std::int32_t>&,
                                        Buffer<Real>& w) {
  grow(scaled_, *device_, batch.square_size());
  const Grid rows{.x = static_cast<std::size_t>(batch.largest_order_pitch()),
                  .y = static_cast<std::size_t>(batch.active_count())};
  scale_rows_(rows, batch.device_segments(), batch.device_active(), z, f, scaled_);
  square_product(*device_, batch, Transpose::kYes, scaled_, z, w);
}

template <class Real>
void ClblastProducts<Real>::apply(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& w,
                                  Buffer<Real>& a) {
  multiply(*device_, batch, x, w, Transpose::kNo, a);
}

template <class Real>
void ClblastProducts<Real>::rotate(const Batch& batch, const Buffer<Real>& x, const Buffer<Real>& z,
                                   Buffer<Real>& b) {
  multiply(*device_, batch, x, z, Transpose::kYes, b);
}

template <class Real>
void ClblastProducts<Real>::compose(const Batch& batch, const Buffer<Real>& p,
                                    const Buffer<Real>& z, Buffer<Real>& c) {
  square_product(*device_, batch, Transpose::kNo, p, z, c);
}

template class ClblastProducts<double>;
template class ClblastProducts<float>;

}  // namespace moclean
