#include "moclean/linalg/norms.hpp"

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/work_group.hpp"

namespace moclean {

template <class Real>
Norms<Real>::InGroups::InGroups(const Device& device, int work_group)
    : program(device, kernel_source::norms_group,
              group_defines(device, work_group, number_type<Real>)),
      block_norms(program, "block_norms") {}

template <class Real>
Norms<Real>::Norms(const Device& device, const Tuning& tuning)
    : device_(&device),
      program_(device, kernel_source::norms, common_defines(device, number_type<Real>)),
      block_norms_(program_, "block_norms"),
      segment_norms_(program_, "segment_norms") {
  if (tuning.form == KernelForm::gpu)
    work_group_ = fit_work_group(in_groups_, device, tuning.work_group);
}

template <class Real>
void Norms<Real>::operator()(const Batch& batch, const Buffer<Real>& x, Buffer<double>& frobenius,
                             Buffer<double>& largest) {
  grow(partial_squares_, *device_, batch.block_count());
  grow(partial_largest_, *device_, batch.block_count());
  Kernel& block_norms = in_groups_ ? in_groups_->block_norms : block_norms_;
  block_norms(in_groups_ ? group_per_block(batch, work_group_) : per_block(batch),
              batch.device_segments(), batch.device_blocks(), batch.active_blocks(), x,
              partial_squares_, partial_largest_);
  segment_norms_(per_segment(batch), batch.device_segments(), batch.device_active(),
                 batch.active_count(), partial_squares_, partial_largest_, frobenius, largest);
}

template class Norms<double>;
template class Norms<float>;

}  // namespace moclean
