#include "moclean/run/take_batch.hpp"

#include <functional>
#include <numeric>

#include "moclean/motion/framed_source.hpp"

namespace moclean {

std::uint64_t bytes_of(const Recording& take, std::uint64_t copies) {
  const auto* source = std::any_cast<FramedSource>(&take.source);
  const std::uint64_t others = source ? source->bytes : 0;
  return others + sizeof(double) * (copies * static_cast<std::uint64_t>(take.samples.size()) +
                                    static_cast<std::uint64_t>(take.channels.size()) +
                                    static_cast<std::uint64_t>(take.confidence.size()));
}

std::uint64_t TakeBatch::bytes() const {
  return std::transform_reduce(takes.begin(), takes.end(), std::uint64_t{0}, std::plus{},
                               [](const TakeInHand& take) { return take.memory.bytes(); });
}

Index TakeBatch::segments() const {
  return std::transform_reduce(takes.begin(), takes.end(), Index{0}, std::plus{},
                               [](const TakeInHand& take) { return take.segments; });
}

void TakeBatch::drop(std::size_t place) {
  clips.erase(clips.begin() + static_cast<std::ptrdiff_t>(place));
  takes.erase(takes.begin() + static_cast<std::ptrdiff_t>(place));
}

}  // namespace moclean
