#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace moclean {

/// The observed samples of a moving window in increasing order.
class SortedWindow {
 public:
  /// NaN is left out, here and in remove().
  void insert(double x) {
    if (!std::isnan(x)) values_.insert(std::ranges::upper_bound(values_, x), x);
  }
  /// `x` is in the window.
  void remove(double x) {
    if (!std::isnan(x)) values_.erase(std::ranges::lower_bound(values_, x));
  }

  /// remove(before), insert(x), in one pass over what lies between the two.
  void replace(double before, double x) {
    if (std::isnan(before) || std::isnan(x)) {
      remove(before);
      insert(x);
      return;
    }
    auto at = std::ranges::lower_bound(values_, before);
    for (; at + 1 != values_.end() && at[1] < x; ++at) at[0] = at[1];
    for (; at != values_.begin() && at[-1] > x; --at) at[0] = at[-1];
    *at = x;
  }

  /// The mean of the two in the middle of an even number; the window is not empty.
  double median() const {
    const std::size_t n = values_.size();
    return n % 2 != 0 ? values_[n / 2] : (values_[n / 2 - 1] + values_[n / 2]) / 2;
  }

  /// Median of |x - m|: the deviations grow outwards from m on both sides, so that merging the
  /// sides gives them in order.
  double median_deviation(double m) const {
    const std::size_t n = values_.size();
    auto right = static_cast<std::size_t>(std::ranges::lower_bound(values_, m) - values_.begin());
    std::size_t left = right;  // one past the next on the left
    double last = 0, before = 0;
    for (std::size_t taken = 0; taken <= n / 2; ++taken) {
      before = last;
      const bool from_left = right == n || (left > 0 && m - values_[left - 1] < values_[right] - m);
      last = from_left ? m - values_[--left] : values_[right++] - m;
    }
    return n % 2 != 0 ? last : (before + last) / 2;
  }

 private:
  std::vector<double> values_;
};

}  // namespace moclean
