#include "moclean/core/usable.hpp"

#include <cmath>

namespace moclean {

std::optional<SamplePlace> first_unusable(const ConstMatrixRef& samples, bool missing_accepted,
                                          double largest) {
  for (Index f = 0; f < samples.rows(); ++f) {
    const auto row = samples.row(f).array();
    if ((row.abs() <= largest).all()) continue;  // false for NaN, too
    for (Index c = 0; c < samples.cols(); ++c)
      if (!(std::abs(row(c)) <= largest) && !(missing_accepted && std::isnan(row(c))))
        return SamplePlace{f, c};
  }
  return std::nullopt;
}

}  // namespace moclean
