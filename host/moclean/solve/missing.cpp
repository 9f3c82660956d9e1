#include "moclean/solve/missing.hpp"

#include <vector>

#include "moclean/core/linear_fill.hpp"

namespace moclean {

bool has_missing(const ConstMatrixRef& data) { return data.array().isNaN().any(); }

Matrix observed_entries(const ConstMatrixRef& data) {
  return (!data.array().isNaN()).cast<double>();
}

Matrix observed_part(const ConstMatrixRef& data) { return data.array().isNaN().select(0, data); }

Matrix filled_along_time(const ConstMatrixRef& data) {
  Matrix filled = data;
  std::vector<double> channel(static_cast<std::size_t>(filled.rows()));
  for (Index column = 0; column < filled.cols(); ++column) {
    const Eigen::Array<bool, Eigen::Dynamic, 1> observed = !data.col(column).array().isNaN();
    Eigen::Map<Eigen::VectorXd> values(channel.data(), filled.rows());
    values = filled.col(column);
    fill_linearly(channel, observed);
    filled.col(column) = values;
  }
  return filled;
}

}  // namespace moclean
