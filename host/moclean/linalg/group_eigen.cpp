#include "moclean/linalg/group_eigen.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work_group.hpp"

namespace moclean {
namespace {

// LAPACK's limit; two sweeps per eigenvalue are usual.
constexpr int max_sweeps = 30;

Defines form_defines(const Device& device, int work_group, bool in_local) {
  Defines defines = group_defines(device, work_group);
  defines["MAX_SWEEPS"] = std::to_string(max_sweeps);
  defines["TRIANGLE_IN_LOCAL"] = std::to_string(in_local ? 1 : 0);
  return defines;
}

Index largest_order(const Batch& batch) {
  Index largest = 0;
  for (const std::int32_t b : batch.active())
    largest = std::max<Index>(largest, batch.segment(b).order);
  return largest;
}

// Reals of local memory that group_diagonalise works with: d, e, two lists of c and s, and its
// counters.
std::size_t rotation_reals(Index order) { return 6 * static_cast<std::size_t>(padded(order)) + 4; }

}  // namespace

GroupEigen::Programs::Programs(const Device& device, int work_group)
    : in_local(device, kernel_source::tridiagonal_group, form_defines(device, work_group, true)),
      in_global(device, kernel_source::tridiagonal_group, form_defines(device, work_group, false)),
      rotation(device, kernel_source::eigen_group, form_defines(device, work_group, true)),
      reduce_in_local(in_local, "group_tridiagonalise"),
      reduce_in_global(in_global, "group_tridiagonalise"),
      accumulate(rotation, "group_accumulate"),
      diagonalise(rotation, "group_diagonalise"),
      sort(rotation, "group_sort") {}

std::size_t GroupEigen::Programs::largest_group() const {
  return std::min({reduce_in_local.largest_group(), reduce_in_global.largest_group(),
                   accumulate.largest_group(), diagonalise.largest_group(), sort.largest_group()});
}

GroupEigen::GroupEigen(const Device& device, const GroupLimits& limits)
    : device_(&device),
      flags_(device),
      local_limit_(std::min(limits.local_memory, device.info().local_memory)),
      work_group_(fit_work_group(programs_, device, limits.work_group)) {}

std::uint64_t GroupEigen::local_memory(Index order, bool triangle) const {
  const auto n = static_cast<std::uint64_t>(order),
             pitch = static_cast<std::uint64_t>(padded(order));
  const std::uint64_t reals = 4 * pitch + static_cast<std::uint64_t>(work_group_);
  return sizeof(double) * (triangle ? reals + n * (n + 1) / 2 : reals);
}

std::uint64_t GroupEigen::memory_of(Index order) {
  const auto n = static_cast<std::uint64_t>(order),
             pitch = static_cast<std::uint64_t>(padded(order));
  return sizeof(double) * ((n + 2) * pitch + 1) + sizeof(std::int32_t) * (pitch + 2);
}

void GroupEigen::reserve(const Batch& batch) {
  grow(vectors_, *device_, batch.square_size());
  grow(d_, *device_, batch.vector_size());
  grow(e_, *device_, batch.vector_size());
  grow(places_, *device_, batch.vector_size());
  grow(scales_, *device_, static_cast<std::size_t>(batch.segments()));
  flags_.reserve(batch);
}

Grid GroupEigen::groups(const Batch& batch) const {
  const auto width = static_cast<std::size_t>(work_group_);
  return {.x = width * static_cast<std::size_t>(batch.active_count()), .group_x = width};
}

void GroupEigen::reduce(const Batch& batch, const Buffer<std::int32_t>& chosen, Buffer<double>& a) {
  const Index order = largest_order(batch);
  const bool in_local = local_memory(order, true) <= local_limit_;
  const LocalMemory<double> memory{local_memory(order, in_local) / sizeof(double)};
  Kernel& kernel = in_local ? programs_->reduce_in_local : programs_->reduce_in_global;
  kernel(groups(batch), batch.device_segments(), batch.device_active(), chosen, a, d_, e_, scales_,
         memory);
}

void GroupEigen::values(const Batch& batch, const Buffer<std::int32_t>& chosen, Buffer<double>& a,
                        Buffer<double>& values) {
  if (batch.active_count() == 0) return;
  const Index order = largest_order(batch);
  const LocalMemory<double> memory{rotation_reals(order)};
  const std::uint64_t needed = std::max(memory.size * sizeof(double), local_memory(order, false));
  if (needed > local_limit_)
    throw DeviceError(fmt::format(
        "the eigensolver needs {} bytes of local memory for a matrix of order {}, {} has {}",
        needed, order, device_->info().name, local_limit_));
  reserve(batch);
  reduce(batch, chosen, a);
  programs_->accumulate(groups(batch), batch.device_segments(), batch.device_active(), chosen, a,
                        vectors_);
  programs_->diagonalise(groups(batch), batch.device_segments(), batch.device_active(), chosen, d_,
                         e_, scales_, vectors_, values, places_, flags_.failed(), memory);
}

void GroupEigen::vectors(const Batch& batch, const Buffer<std::int32_t>& wanted,
                         Buffer<double>& z) {
  programs_->sort(groups(batch), batch.device_segments(), batch.device_active(), wanted, vectors_,
                  places_, z);
}

void GroupEigen::all_values(const Batch& batch, Buffer<double>& a, Buffer<double>& values) {
  flags_.reserve(batch);
  this->values(batch, flags_.all(), a, values);
}

void GroupEigen::all_vectors(const Batch& batch, Buffer<double>& z) {
  vectors(batch, flags_.all(), z);
}

void GroupEigen::operator()(const Batch& batch, Buffer<double>& a, Buffer<double>& z,
                            Buffer<double>& values) {
  all_values(batch, a, values);
  all_vectors(batch, z);
}

void GroupEigen::check(const Batch& batch) { flags_.check(batch); }

}  // namespace moclean
