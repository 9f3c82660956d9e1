#include "moclean/formats/table_times.hpp"

#include <algorithm>
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
    if (step < 1.5 * median && median < 1.5 * step) {
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

}  // namespace

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
