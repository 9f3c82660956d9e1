#include "moclean/linalg/eigen.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work.hpp"

namespace moclean {
namespace {

// QL takes less than two sweeps per eigenvalue, over half of the matrix on average: less than one
// rotation per entry. Twice that, and four sweeps, is given before it counts as failed.
constexpr int sweeps_per_row = 4;
constexpr int rotations_per_entry = 2;
// Vectors of `order` entries the reduction works with: v, w, p.
constexpr std::size_t scratch_vectors = 3;
// Vectors of interleaved scratch of QL: d, e, and two for rotations that are not part of any sweep.
constexpr std::size_t lane_vectors = 4;

Defines eigen_defines(const Device& device, int panel, double negligible) {
  Defines defines = common_defines(device);
  defines["SWEEPS_PER_ROW"] = std::to_string(sweeps_per_row);
  defines["ROTATIONS_PER_ENTRY"] = std::to_string(rotations_per_entry);
  defines["PANEL"] = std::to_string(panel);
  defines["NEGLIGIBLE"] = fmt::format("{:.17g}", negligible);
  return defines;
}

// One program of three files: a compiler reads its own headers once for it, 0.3 s with PoCL.
// tridiagonal_ql comes last, for its pragma holds to the end.
std::string eigen_source() {
  return std::string(kernel_source::tridiagonal)
      .append(kernel_source::eigenvectors)
      .append(kernel_source::tridiagonal_ql);
}

std::size_t groups(std::size_t items, int group) {
  return (items + static_cast<std::size_t>(group) - 1) / static_cast<std::size_t>(group);
}

}  // namespace

SymmetricEigen::SymmetricEigen(const Device& device, int panel, double negligible)
    : device_(&device),
      flags_(device),
      vector_width_(vector_width(device)),
      panel_(panel),
      program_(device, eigen_source(), eigen_defines(device, panel, negligible)),
      tridiagonalise_(program_, "tridiagonalise"),
      diagonalise_(program_, "diagonalise"),
      transform_(program_, "eigenvectors") {}

std::uint64_t SymmetricEigen::memory_of(Index order) {
  const auto square = static_cast<std::uint64_t>(order * padded(order));
  const auto vector = static_cast<std::uint64_t>(padded(order));
  return (1 + 2 * rotations_per_entry) * square * sizeof(double) +
         (2 + scratch_vectors + lane_vectors) * vector * sizeof(double) +
         (2 * sweeps_per_row + 1) * vector * sizeof(std::int32_t);
}

void SymmetricEigen::reserve(const Batch& batch) {
  const auto segments = static_cast<std::size_t>(batch.segments());
  const auto rows = static_cast<std::size_t>(batch.largest_order_pitch());
  grow(reflectors_, *device_, batch.square_size());
  grow(rotations_, *device_, 2 * rotations_per_entry * batch.square_size());
  grow(sweeps_, *device_, 2 * sweeps_per_row * batch.vector_size());
  grow(d_, *device_, batch.vector_size());
  grow(e_, *device_, batch.vector_size());
  grow(places_, *device_, batch.vector_size());
  grow(scratch_, *device_, scratch_vectors * batch.vector_size());
  const auto width = static_cast<std::size_t>(vector_width_);
  grow(lanes_, *device_, groups(segments, vector_width_) * lane_vectors * (rows + 1) * width);
  grow(scales_, *device_, segments);
  grow(sweep_counts_, *device_, segments);
  flags_.reserve(batch);
}

// Householder reduction: 4/3 n^3, in which one triangle is read and the reflectors are written.
Work SymmetricEigen::reduction_work(const Batch& batch, const Buffer<std::int32_t>& chosen) const {
  const auto is_chosen = host_copy(chosen);
  return total_work(batch, [&](std::size_t b, const SegmentRecord& segment) {
    const double n = segment.order;
    if (is_chosen[b] == 0) return Work{};
    return Work{.flops = 4.0 / 3 * n * n * n, .bytes = n * n * sizeof(double)};
  });
}

// For each vector 6 flops per rotation and 4 per entry of a reflector; the rotations are counted,
// those included that pass over zeros.
Work SymmetricEigen::transformation_work(const Batch& batch,
                                         const Buffer<std::int32_t>& wanted) const {
  const auto vectors = host_copy(wanted), sweep_counts = host_copy(sweep_counts_),
             sweeps = host_copy(sweeps_);
  return total_work(batch, [&](std::size_t b, const SegmentRecord& segment) {
    const int* sweep = sweeps.data() + 2 * sweeps_per_row * segment.vector;
    double rotations = 0;
    for (int i = 0; i < sweep_counts[b]; ++i) rotations += sweep[2 * i + 1] - sweep[2 * i];
    const double n = segment.order;
    const double count = std::min(vectors[b], segment.order);
    if (count == 0) return Work{};
    return Work{.flops = count * (6 * rotations + 2 * n * n),
                .bytes = (2 * rotations + n * n / 2 + count * n) * sizeof(double)};
  });
}

void SymmetricEigen::values(const Batch& batch, const Buffer<std::int32_t>& chosen,
                            Buffer<double>& a, Buffer<double>& values) {
  reserve(batch);
  tridiagonalise_.with([&] { return reduction_work(batch, chosen); })(
      per_segment(batch), batch.device_segments(), batch.device_active(), batch.active_count(),
      chosen, a, reflectors_, d_, e_, scales_, scratch_);
  diagonalise_(Grid{.x = groups(batch.active().size(), vector_width_)}, batch.device_segments(),
               batch.device_active(), batch.active_count(), chosen, batch.largest_order_pitch(), d_,
               e_, scales_, lanes_, rotations_, sweeps_, sweep_counts_, values, places_,
               flags_.failed());
}

void SymmetricEigen::all_values(const Batch& batch, Buffer<double>& a, Buffer<double>& values) {
  flags_.reserve(batch);
  this->values(batch, flags_.all(), a, values);
}

void SymmetricEigen::vectors(const Batch& batch, const Buffer<std::int32_t>& wanted,
                             Buffer<double>& a, Buffer<double>& z) {
  const Grid panels{
      .x = groups(static_cast<std::size_t>(batch.largest_order_pitch()), panel_ * vector_width_),
      .y = batch.active().size()};
  transform_.with([&] { return transformation_work(batch, wanted); })(
      panels, batch.device_segments(), batch.device_active(), wanted, reflectors_, rotations_,
      sweeps_, sweep_counts_, places_, a, z);
}

void SymmetricEigen::all_vectors(const Batch& batch, Buffer<double>& a, Buffer<double>& z) {
  vectors(batch, flags_.all(), a, z);
}

void SymmetricEigen::operator()(const Batch& batch, Buffer<double>& a, Buffer<double>& z,
                                Buffer<double>& values) {
  all_values(batch, a, values);
  all_vectors(batch, a, z);
}

void SymmetricEigen::check(const Batch& batch) { flags_.check(batch); }

}  // namespace moclean
