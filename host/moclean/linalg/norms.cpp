#include "moclean/linalg/norms.hpp"

#include "moclean/device/kernel_source.hpp"

namespace moclean {

template <class Real>
Norms<Real>::Norms(const Device& device)
    : device_(&device),
      program_(device, kernel_source::norms, common_defines(device, number_type<Real>)),
      block_norms_(program_, "block_norms"),
      segment_norms_(program_, "segment_norms") {}

template <class Real>
void Norms<Real>::operator()(const Batch& batch, const Buffer<Real>& x, Buffer<double>& frobenius,
                             Buffer<double>& largest) {
  grow(partial_squares_, *device_, batch.block_count());
  grow(partial_largest_, *device_, batch.block_count());
  block_norms_(per_block(batch), batch.device_segments(), batch.device_blocks(),
               batch.active_blocks(), x, partial_squares_, partial_largest_);
  segment_norms_(per_segment(batch), batch.device_segments(), batch.device_active(),
                 batch.active_count(), partial_squares_, partial_largest_, frobenius, largest);
}

template class Norms<double>;
template class Norms<float>;

}  // namespace moclean
