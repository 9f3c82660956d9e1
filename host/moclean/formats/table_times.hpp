#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace moclean {

/// What a time column tells.
struct TimeScale {
  double rate = 0;        ///< Hz; 0 where it tells none
  std::string unit = {};  ///< that its values are in, if neither seconds nor named by the column
};

/// The rate by times of a column named `name`: the mean of those steps that lie within a factor 1.5
/// of the median step. Frames left out make few steps too long, and printed times make every step a
/// little wrong, which the mean evens out. Without a unit in the name, values of UNIX time in
/// milliseconds, microseconds or nanoseconds are told by their size, and steps above 1 are
/// milliseconds; steps of exactly 1 are numbers of frames and tell no rate.
TimeScale time_scale(const std::vector<double>& times, std::string_view name);

}  // namespace moclean
