#include "moclean/filter/window.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/order_statistics.hpp"
#include "moclean/core/sorted_window.hpp"

namespace moclean {
namespace {

// The work per frame is proportional to the window.
constexpr Index longest_window = 9999;

void require_odd(std::string_view filter, Index window) {
  if (window < 1 || window % 2 == 0 || window > longest_window)
    throw ArgumentError(fmt::format("{}: window is {}, expected an odd number of frames up to {}",
                                    filter, window, longest_window));
}

// Weighted mean around each sample, weights[t] for the samples t frames before and after.
void weighted_mean(const std::vector<double>& weights, std::span<double> channel) {
  const std::vector<double> y(channel.begin(), channel.end());
  const auto frames = static_cast<Index>(y.size());
  const auto half = static_cast<Index>(weights.size()) - 1;
  for (Index i = 0; i < frames; ++i) {
    double& result = channel[static_cast<std::size_t>(i)];
    if (std::isnan(result)) continue;
    double sum = 0, weight = 0;
    for (Index j = std::max<Index>(0, i - half); j <= std::min(frames - 1, i + half); ++j) {
      const double w = weights[static_cast<std::size_t>(std::abs(i - j))];
      const double x = y[static_cast<std::size_t>(j)];
      if (std::isnan(x)) continue;
      sum += w * x;
      weight += w;
    }
    result = sum / weight;
  }
}

// Calls replace(x, window) for the observed samples of [begin, end), the window being centred on
// them.
template <class Replace>
void replace_each(const std::vector<double>& y, std::size_t begin, std::size_t end,
                  std::size_t half, std::span<double> channel, const Replace& replace) {
  SortedWindow sorted;
  const std::size_t first = begin < half ? 0 : begin - half;
  for (std::size_t i = first; i < std::min(begin + half, y.size()); ++i) sorted.insert(y[i]);
  for (std::size_t i = begin; i < end; ++i) {
    if (i + half < y.size()) sorted.insert(y[i + half]);
    if (i > begin && i > half) sorted.remove(y[i - half - 1]);
    if (!std::isnan(y[i])) replace(channel[i], sorted);
  }
}

// The whole windows of `width` neighbouring samples side by side, in vector lanes: samples_[k](l)
// is the k-th of the l-th window.
class WindowBlock {
 public:
  static constexpr Index width = 64, largest_window = 15;
  using Row = Eigen::Array<double, width, 1>;

  // The windows that begin with y, y + 1 ...
  WindowBlock(const double* y, std::size_t window) : window_(window) {
    for (std::size_t k = 0; k < window; ++k) samples_[k] = Eigen::Map<const Row>(y + k);
  }

  // Bubbles the larger half of each window to its end; the least of it is the median.
  const Row& medians() {
    const std::size_t half = window_ / 2;
    for (std::size_t pass = 0; pass <= half; ++pass)
      for (std::size_t k = 0; k + 1 < window_ - pass; ++k) exchange(samples_[k], samples_[k + 1]);
    return samples_[half];
  }

  void replace_by_deviations(const Row& centre) {
    for (std::size_t k = 0; k < window_; ++k) samples_[k] = (samples_[k] - centre).abs();
  }

 private:
  static void exchange(Row& less, Row& more) {
    for (Index l = 0; l < width; l += lanes) {
      const Eigen::Array<double, lanes, 1> a = less.segment<lanes>(l), b = more.segment<lanes>(l);
      less.segment<lanes>(l) = a.min(b);
      more.segment<lanes>(l) = a.max(b);
    }
  }

  static constexpr Index lanes = 8;
  std::size_t window_;
  std::array<Row, largest_window> samples_;
};

// Calls replace(x, window) for every observed sample, replace_block(x, block) for
// WindowBlock::width of them where none is missing and all windows are whole. Both have to give the
// same bits.
template <class Replace, class ReplaceBlock>
void for_each_window(Index window, std::span<double> channel, const Replace& replace,
                     const ReplaceBlock& replace_block) {
  const std::vector<double> y(channel.begin(), channel.end());
  const auto length = static_cast<std::size_t>(window), half = length / 2;
  const bool complete = std::ranges::none_of(y, [](double x) { return std::isnan(x); });
  std::size_t i = 0;
  if (complete && window <= WindowBlock::largest_window && y.size() > 2 * half) {
    constexpr auto width = static_cast<std::size_t>(WindowBlock::width);
    replace_each(y, 0, half, half, channel, replace);
    for (i = half; i + width + half <= y.size(); i += width) {
      WindowBlock block(y.data() + i - half, length);
      replace_block(channel.subspan(i, width), block);
    }
  }
  replace_each(y, i, y.size(), half, channel, replace);
}

}  // namespace

void check(const MovingAverage& filter) { require_odd(MovingAverage::name, filter.window); }

void check(const GaussianFilter& filter) {
  constexpr double largest_sd = 1000;
  if (!(filter.sd > 0 && filter.sd <= largest_sd))
    throw ArgumentError(
        fmt::format("gaussian: sd is {}, expected a positive number of frames up to {}", filter.sd,
                    largest_sd));
}

void check(const MedianFilter& filter) { require_odd(MedianFilter::name, filter.window); }

void check(const Hampel& filter) {
  require_odd(Hampel::name, filter.window);
  if (!(filter.sigmas >= 0 && std::isfinite(filter.sigmas)))
    throw ArgumentError(fmt::format("hampel: sigmas is {}, expected at least 0", filter.sigmas));
}

void smooth(const MovingAverage& filter, double, std::span<double> channel) {
  weighted_mean(std::vector<double>(static_cast<std::size_t>(filter.window / 2 + 1), 1.0), channel);
}

void smooth(const GaussianFilter& filter, double, std::span<double> channel) {
  constexpr double deviations = 4;
  std::vector<double> weights(static_cast<std::size_t>(deviations * filter.sd + 0.5) + 1);
  for (std::size_t t = 0; t < weights.size(); ++t) {
    const double x = static_cast<double>(t) / filter.sd;
    weights[t] = std::exp(-x * x / 2);
  }
  weighted_mean(weights, channel);
}

void smooth(const MedianFilter& filter, double, std::span<double> channel) {
  for_each_window(
      filter.window, channel, [](double& x, const SortedWindow& window) { x = window.median(); },
      [](std::span<double> x, WindowBlock& block) {
        Eigen::Map<WindowBlock::Row>(x.data()) = block.medians();
      });
}

void smooth(const Hampel& filter, double, std::span<double> channel) {
  const auto bound = [&](double mad) { return filter.sigmas * deviation_per_mad * mad; };
  for_each_window(
      filter.window, channel,
      [&](double& x, const SortedWindow& window) {
        const double m = window.median();
        if (std::abs(x - m) > bound(window.median_deviation(m))) x = m;
      },
      [&](std::span<double> x, WindowBlock& block) {
        const WindowBlock::Row m = block.medians();
        block.replace_by_deviations(m);
        const WindowBlock::Row& mad = block.medians();
        for (Index l = 0; l < WindowBlock::width; ++l) {
          double& sample = x[static_cast<std::size_t>(l)];
          if (std::abs(sample - m(l)) > bound(mad(l))) sample = m(l);
        }
      });
}

}  // namespace moclean
