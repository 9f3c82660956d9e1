#include "moclean/linalg/norms.hpp"

#include "moclean/device/kernel_source.hpp"

namespace moclean {

Norms::Norms(const Device& device)
    : device_(&device),
      program_(device, kernel_source::norms, common_defines(device)),
      block_norms_(program_, "block_norms"),
      segment_norms_(program_, "segment_norms") {}

void Norms::operator()(const Batch& batch, const Buffer<double>& x, Buffer<double>& frobenius,
                       Buffer<double>& largest) {
  if (partial_squares_.size() < batch.block_count()) {
    partial_squares_ = Buffer<double>(*device_, batch.block_count());
    partial_largest_ = Buffer<double>(*device_, batch.block_count());
  }
  block_norms_(per_block(batch), batch.device_segments(), batch.device_blocks(),
               batch.active_blocks(), x, partial_squares_, partial_largest_);
  segment_norms_(per_segment(batch), batch.device_segments(), batch.device_active(),
                 batch.active_count(), partial_squares_, partial_largest_, frobenius, largest);
}

}  // namespace moclean
