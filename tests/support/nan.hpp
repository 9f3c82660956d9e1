#pragma once

#include <limits>

namespace moclean::test {

/// A sample that was not observed.
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace moclean::test
