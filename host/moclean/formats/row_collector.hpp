#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// The rows of a matrix, from a file that does not say how many there will be.
class RowCollector {
 public:
  explicit RowCollector(Index columns) : rows_(0, columns) {}

  Index count() const { return count_; }

  /// Room for one more row, not initialised; `bytes_left` of the text follow. Memory is reserved
  /// for as many rows as will come if they take as much text as those before, and grows where that
  /// was too few.
  double* add(std::size_t bytes_left) {
    const auto left = static_cast<Index>(bytes_left);
    if (count_ == 0) start_ = left;
    if (count_ == rows_.rows()) {
      const Index expected = left * count_ / std::max<Index>(1, start_ - left);
      rows_.conservativeResize(count_ + expected + count_ / 64 + 1, Eigen::NoChange);
    }
    return rows_.row(count_++).data();
  }

  /// All rows that were added; the collector is spent.
  Matrix take() {
    rows_.conservativeResize(count_, Eigen::NoChange);
    return std::move(rows_);
  }

 private:
  Matrix rows_;
  Index count_ = 0;
  Index start_ = 0;  // bytes left before the first row
};

}  // namespace moclean
