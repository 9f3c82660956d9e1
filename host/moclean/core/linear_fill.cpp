#include "moclean/core/linear_fill.hpp"

#include <algorithm>

namespace moclean {
namespace {

using Samples = std::span<double>;

// Fills channel[first, last) between the observed samples beside it, those that there are.
void fill(Samples channel, std::size_t first, std::size_t last) {
  const bool begins = first == 0, ends = last == channel.size();
  const double left = begins ? (ends ? 0 : channel[last]) : channel[first - 1];
  const double right = ends ? left : channel[last];
  const auto steps = static_cast<double>(last - first + 1);
  for (std::size_t k = first; k < last; ++k)
    channel[k] = left + static_cast<double>(k + 1 - first) / steps * (right - left);
}

}  // namespace

void fill_linearly(std::span<double> channel, const ObservedChannel& observed) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < channel.size(); ++i) {
    if (!observed(static_cast<Eigen::Index>(i))) continue;
    fill(channel, first, i);
    first = i + 1;
  }
  fill(channel, first, channel.size());
}

}  // namespace moclean
