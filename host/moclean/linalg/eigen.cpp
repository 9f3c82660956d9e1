#include "moclean/linalg/eigen.hpp"

#include <algorithm>

#include "moclean/device/kernel_source.hpp"

namespace moclean {
namespace {

// LAPACK's limit; two sweeps per eigenvalue are usual.
constexpr int max_sweeps = 30;
// Vectors of `order` entries the kernel works with: d, e, v, w, p.
constexpr std::size_t scratch_vectors = 5;

Defines eigen_defines(const Device& device) {
  Defines defines = common_defines(device);
  defines["MAX_SWEEPS"] = std::to_string(max_sweeps);
  return defines;
}

}  // namespace

SymmetricEigen::SymmetricEigen(const Device& device)
    : device_(&device),
      program_(device, kernel_source::eigen, eigen_defines(device)),
      kernel_(program_, "symmetric_eigen") {}

void SymmetricEigen::reserve(const Batch& batch) {
  if (work_.size() < batch.square_size()) work_ = Buffer<double>(*device_, batch.square_size());
  if (scratch_.size() < scratch_vectors * batch.vector_size())
    scratch_ = Buffer<double>(*device_, scratch_vectors * batch.vector_size());
  const auto segments = static_cast<std::size_t>(batch.segments());
  if (failed_.size() < segments) {
    failed_ = Buffer<std::int32_t>(*device_, segments);
    failed_.fill_zero();
  }
}

void SymmetricEigen::operator()(const Batch& batch, Buffer<double>& a, Buffer<double>& z,
                                Buffer<double>& values) {
  reserve(batch);
  kernel_(per_segment(batch), batch.device_segments(), batch.device_active(), batch.active_count(),
          a, z, values, work_, scratch_, failed_);
}

void SymmetricEigen::check(const Batch& batch) {
  std::vector<std::int32_t> failed(static_cast<std::size_t>(batch.segments()));
  failed_.read(failed);
  const auto first = std::find(failed.begin(), failed.end(), 1);
  if (first == failed.end()) return;
  failed_.fill_zero();
  throw DeviceError("the eigensolver did not converge for segment " +
                    std::to_string(first - failed.begin()) + " of a batch on " +
                    device_->info().name);
}

}  // namespace moclean
