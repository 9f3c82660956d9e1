#include "moclean/formats/table_times.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>

#include "moclean/formats/column_names.hpp"
#include "moclean/formats/frame_rate.hpp"

namespace moclean {
namespace {

// Mean of the usual steps, and whether all are 1.
double usual_step(const std::vector<double>& times, bool& counts) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  counts = std::ranges::all_of(steps, [](double step) { return step == 1; });
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double median = *middle;
  double sum = 0, count = 0;
  for (const double step : steps)
    if (std::abs(step - median) <= 0.5 * median * (1 + 1e-6)) {
      sum += step;
      ++count;
    }
  return sum / count;
}

// Times that were computed from a rate of few digits give it back.
double rate_of_steps(double seconds) {
  const double rate = rate_from_period(seconds);
  const double rounded = std::round(1000 * rate) / 1000;
  return std::abs(rate - rounded) <= 1e-9 * rate ? rounded : rate;
}

// Takes digits from the front of a text; nothing if there are fewer or more than that many.
std::optional<int> take_digits(std::string_view& text, std::size_t least, std::size_t most) {
  std::size_t count = 0;
  int value = 0;
  while (count < text.size() && count <= most && text[count] >= '0' && text[count] <= '9')
    value = 10 * value + (text[count++] - '0');
  if (count < least || count > most) return std::nullopt;
  text.remove_prefix(count);
  return value;
}

bool take(std::string_view& text, char a, char b) {
  if (text.empty() || (text[0] != a && text[0] != b)) return false;
  text.remove_prefix(1);
  return true;
}

// `2024-05-01T`; moves behind it and gives the seconds since 1970.
std::optional<std::int64_t> take_date(std::string_view& text) {
  const auto year = take_digits(text, 4, 4);
  if (!year || !take(text, '-', '/')) return std::nullopt;
  const auto month = take_digits(text, 1, 2);
  if (!month || !take(text, '-', '/')) return std::nullopt;
  const auto day = take_digits(text, 1, 2);
  if (!day || !take(text, 'T', ' ')) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;
  return std::int64_t{86400} * std::chrono::sys_days(date).time_since_epoch().count();
}

// `Z`, `+02:00`, `-0530`, or nothing: how far the clock is ahead, in seconds.
std::optional<std::int64_t> zone_offset(std::string_view text) {
  if (text.empty() || text == "Z" || text == " UTC") return 0;
  const bool is_behind = text[0] == '-';
  if (!take(text, '+', '-')) return std::nullopt;
  const bool is_joined = text.size() == 4;
  const auto hours = take_digits(text, 2, is_joined ? 4 : 2);
  if (!hours) return std::nullopt;
  std::int64_t minutes = is_joined ? 60 * (*hours / 100) + *hours % 100 : 60 * *hours;
  if (take(text, ':', ':')) {
    const auto rest = take_digits(text, 2, 2);
    if (!rest) return std::nullopt;
    minutes += *rest;
  }
  if (!text.empty()) return std::nullopt;
  return (is_behind ? -60 : 60) * minutes;
}

}  // namespace

std::optional<ClockTime> clock_time(std::string_view text) {
  constexpr std::size_t longest = 40;
  if (text.size() < 5 || text.size() > longest) return std::nullopt;
  ClockTime time;
  if (text.size() > 10 && (text[4] == '-' || text[4] == '/')) {
    const auto date = take_date(text);
    if (!date) return std::nullopt;
    time.seconds = *date;
    time.has_date = true;
  }
  const auto first = take_digits(text, 1, 2);
  if (!first || !take(text, ':', ':')) return std::nullopt;
  const auto second = take_digits(text, 2, 2);
  if (!second) return std::nullopt;
  const bool has_hours = take(text, ':', ':');
  const auto third = has_hours ? take_digits(text, 2, 2) : std::optional(0);
  if (!third) return std::nullopt;
  const bool has_decimals = take(text, '.', ',');
  if (!has_hours && (!has_decimals || time.has_date)) return std::nullopt;
  if (has_decimals) {
    double unit = 0.1;
    const std::size_t size = text.size();
    for (; !text.empty() && text[0] >= '0' && text[0] <= '9'; unit /= 10, text.remove_prefix(1))
      time.fraction += unit * (text[0] - '0');
    if (text.size() == size) return std::nullopt;
  }
  const auto offset = zone_offset(text);
  const int hours = has_hours ? *first : 0, minutes = has_hours ? *second : *first;
  const int seconds = has_hours ? *third : *second;
  if (!offset || hours > 24 || (has_hours && minutes > 59) || seconds > 60) return std::nullopt;
  time.seconds += 3600 * hours + 60 * minutes + seconds - *offset;
  return time;
}

TimeScale time_scale(const std::vector<double>& times, std::string_view name) {
  const auto is_finite = [](double time) { return std::isfinite(time); };
  if (times.size() < 2 || !std::ranges::all_of(times, is_finite)) return {};
  bool counts = false;
  const double step = usual_step(times, counts);
  if (!(step > 0)) return {};
  if (const double scale = seconds_per_unit(name); scale > 0) return {rate_of_steps(scale * step)};
  // UNIX time of 1973 to 5138 in seconds, and in parts of it.
  const double size = std::abs(times.front());
  if (size >= 1e17) return {rate_of_steps(1e-9 * step), "nanoseconds"};
  if (size >= 1e14) return {rate_of_steps(1e-6 * step), "microseconds"};
  if (size >= 1e11) return {rate_of_steps(1e-3 * step), "milliseconds"};
  if (counts && size < 1e8) return {0, "frames"};
  if (step > 1) return {rate_of_steps(1e-3 * step), "milliseconds"};
  return {rate_of_steps(step)};
}

}  // namespace moclean
