#include "moclean/linalg/banded.hpp"

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work.hpp"
#include "moclean/linalg/work_group.hpp"

namespace moclean {
namespace {

Defines banded_defines(const Device& device, NumberType type, int width) {
  if (width < 1 || width > 3)
    throw ArgumentError(fmt::format("half-bandwidth is {}, expected 1, 2 or 3", width));
  Defines defines = common_defines(device, type);
  defines["WIDTH"] = std::to_string(width);
  return defines;
}

cl_long stacked_size(const Batch& batch) { return static_cast<cl_long>(batch.stacked_size()); }

}  // namespace

template <class Real>
Banded<Real>::Banded(const Device& device, int width)
    : device_(&device),
      width_(width),
      program_(device, kernel_source::banded, banded_defines(device, number_type<Real>, width)),
      assemble_columns_(program_, "assemble_columns"),
      factor_columns_(program_, "factor_columns"),
      solve_columns_(program_, "solve_columns"),
      factor_shared_(program_, "factor_shared"),
      solve_shared_(program_, "solve_shared"),
      penalise_(program_, "penalise") {}

template <class Real>
Grid Banded<Real>::per_vector(const Batch& batch) const {
  return per_column(batch, *device_, number_type<Real>);
}

template <class Real>
Work Banded<Real>::solve_work(const Batch& batch, bool shared) const {
  return total_work(batch, [&](std::size_t, const SegmentRecord& segment) {
    const double entries = double(segment.rows) * segment.columns;
    const double bands = (2 * width_ + 1) * (shared ? double(segment.rows) : entries);
    return Work{.flops = (4 * width_ + 1) * entries, .bytes = (4 * entries + bands) * sizeof(Real)};
  });
}

template <class Real>
void Banded<Real>::assemble(const Batch& batch, const Buffer<Real>& weights,
                            const Buffer<Real>& penalties, ColumnBands<Real>& bands) {
  assemble_columns_(per_vector(batch), batch.device_segments(), batch.device_active(),
                    stacked_size(batch), weights, penalties, bands.bands);
}

template <class Real>
void Banded<Real>::factor(const Batch& batch, ColumnBands<Real>& bands) {
  factor_columns_(per_vector(batch), batch.device_segments(), batch.device_active(),
                  stacked_size(batch), bands.bands);
}

template <class Real>
void Banded<Real>::factor(const Batch& batch, const Buffer<Real>& weights,
                          const Buffer<Real>& penalties, SharedBands<Real>& bands) {
  factor_shared_(per_segment(batch), batch.device_segments(), batch.device_active(),
                 batch.active_count(), weights, penalties, bands.bands);
}

template <class Real>
void Banded<Real>::solve(const Batch& batch, const ColumnBands<Real>& factor, const Buffer<Real>& b,
                         Buffer<Real>& x) {
  solve_columns_.with([&] { return solve_work(batch, false); })(
      per_vector(batch), batch.device_segments(), batch.device_active(), stacked_size(batch),
      factor.bands, b, x);
}

template <class Real>
void Banded<Real>::solve(const Batch& batch, const SharedBands<Real>& factor, const Buffer<Real>& b,
                         Buffer<Real>& x) {
  solve_shared_.with([&] { return solve_work(batch, true); })(
      per_vector(batch), batch.device_segments(), batch.device_active(), factor.bands, b, x);
}

template <class Real>
void Banded<Real>::penalise(const Batch& batch, const Buffer<Real>& x, Buffer<Real>& y) {
  penalise_(per_block(batch), batch.device_segments(), batch.device_blocks(), batch.active_blocks(),
            x, y);
}

template class Banded<double>;
template class Banded<float>;

}  // namespace moclean
