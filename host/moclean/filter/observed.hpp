#pragma once

#include <cmath>
#include <span>

namespace moclean {

/// Calls work(run) for every longest run of samples that are not NaN.
template <class Work>
void for_each_run(std::span<double> channel, const Work& work) {
  for (std::size_t begin = 0; begin < channel.size();) {
    std::size_t end = begin;
    while (end < channel.size() && !std::isnan(channel[end])) ++end;
    if (end > begin) work(channel.subspan(begin, end - begin));
    begin = end + 1;
  }
}

/// The channel from its first to its last sample that is not NaN; empty if there is none.
inline std::span<double> between_ends(std::span<double> channel) {
  while (!channel.empty() && std::isnan(channel.front())) channel = channel.subspan(1);
  while (!channel.empty() && std::isnan(channel.back()))
    channel = channel.first(channel.size() - 1);
  return channel;
}

/// Times 2^exponent, which changes no digit: so that squares of samples are numbers, and none less
/// than normal.
inline void scale_by_power(std::span<double> channel, int exponent) {
  for (double& y : channel) y = std::ldexp(y, exponent);
}

}  // namespace moclean
