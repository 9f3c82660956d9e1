#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace moclean {

/// What a time column tells.
struct TimeScale {
  double rate = 0;        ///< Hz; 0 where it tells none
  std::string unit = {};  ///< that its values are in, if neither seconds nor named by the column
};

/// A time of day, or of a date.
struct ClockTime {
  std::int64_t seconds = 0;  ///< since midnight or, with a date, since 1970
  double fraction = 0;       ///< of a second
  bool has_date = false;
};

/// A time as clocks show it: `12:34:56.789`, `5:01.25` (minutes and seconds, with decimals), and
/// after ISO 8601 `2024-05-01T12:34:56.789Z`, also with a blank for the T, slashes in the date and
/// another zone (`+02:00`); the decimal mark may be a comma. Nothing for any other text.
std::optional<ClockTime> clock_time(std::string_view text);

/// The rate by times of a column named `name`: the mean of those steps that differ from the median
/// one by at most half of it. Frames left out make few steps too long, and printed times make every
/// step a little wrong (2 or 3 ms at 400 Hz), which the mean evens out. Without a unit in the name,
/// values of UNIX time in milliseconds, microseconds or nanoseconds are told by their size, and
/// steps above 1 are milliseconds; steps of exactly 1 are numbers of frames and tell no rate.
TimeScale time_scale(const std::vector<double>& times, std::string_view name);

}  // namespace moclean
