#include "moclean/denoise/unobserved.hpp"

#include <limits>

namespace moclean {
namespace {

bool never_observed(const Recording& take, Index column) {
  return take.samples.col(column).array().isNaN().all();
}

}  // namespace

std::vector<std::string> unobserved_columns(const Recording& take) {
  std::vector<std::string> names;
  for (Index column = 0; column < take.samples.cols(); ++column)
    if (never_observed(take, column))
      names.push_back(take.columns[static_cast<std::size_t>(column)]);
  return names;
}

void leave_unobserved(const Recording& take, Denoised& result) {
  result.unobserved = unobserved_columns(take);
  if (result.unobserved.empty()) return;
  for (Index column = 0; column < take.samples.cols(); ++column) {
    if (!never_observed(take, column)) continue;
    result.motion.col(column).setConstant(std::numeric_limits<double>::quiet_NaN());
    result.outliers.col(column).setZero();
  }
}

}  // namespace moclean
