#include "moclean/solve/missing.hpp"

#include <cmath>

namespace moclean {
namespace {

// Fills the rows between two observed ones; -1 and the number of rows mean that there is none.
void fill_gap(Matrix& data, Index column, Index before, Index after) {
  const bool first = before < 0, last = after == data.rows();
  for (Index i = before + 1; i < after; ++i) {
    if (first && last) {
      data(i, column) = 0;
    } else if (first || last) {
      data(i, column) = data(first ? after : before, column);
    } else {
      const double share = static_cast<double>(i - before) / static_cast<double>(after - before);
      data(i, column) = data(before, column) + share * (data(after, column) - data(before, column));
    }
  }
}

}  // namespace

bool has_missing(const ConstMatrixRef& data) { return data.array().isNaN().any(); }

Matrix observed_entries(const ConstMatrixRef& data) {
  return (!data.array().isNaN()).cast<double>();
}

Matrix observed_part(const ConstMatrixRef& data) { return data.array().isNaN().select(0, data); }

Matrix filled_along_time(const ConstMatrixRef& data) {
  Matrix filled = data;
  for (Index column = 0; column < filled.cols(); ++column) {
    Index before = -1;
    for (Index i = 0; i < filled.rows(); ++i)
      if (!std::isnan(filled(i, column))) {
        fill_gap(filled, column, before, i);
        before = i;
      }
    fill_gap(filled, column, before, filled.rows());
  }
  return filled;
}

}  // namespace moclean
