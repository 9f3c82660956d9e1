#pragma once

#include <optional>
#include <string_view>

namespace moclean {

/// How many millimetres a length unit is, named as Recording::unit names it: mm, cm, m, or "ASF
/// units", which are 2.54 cm / 0.45 = 56.44 mm in the files of CMU and HDM05 (`length 0.45`, an
/// inch). Nothing for any other.
std::optional<double> millimetres(std::string_view unit);

}  // namespace moclean
