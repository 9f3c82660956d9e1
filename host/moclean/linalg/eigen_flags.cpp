#include "moclean/linalg/eigen_flags.hpp"

#include <algorithm>
#include <limits>

namespace moclean {

void EigenFlags::reserve(const Batch& batch) {
  const auto segments = static_cast<std::size_t>(batch.segments());
  if (failed_.size() >= segments) return;
  failed_ = Buffer<std::int32_t>(*device_, segments);
  failed_.fill_zero();
  const std::vector<std::int32_t> all(segments, std::numeric_limits<std::int32_t>::max());
  all_ = Buffer<std::int32_t>(*device_, std::span<const std::int32_t>(all));
}

void EigenFlags::check(const Batch& batch) {
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
