#include "moclean/formats/missing_marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace moclean {
namespace {

// Numbers that programs write where they have none.
constexpr std::array<double, 9> usual_marks = {-9999, -999,   -99999, -999999, 9999,
                                               99999, 999999, -32768, -1e6};
constexpr Index fewest_frames = 3;  // that say it

using Samples = Eigen::Ref<const Eigen::RowVectorXd>;

bool says(const Samples& point, double mark) {
  if (point.size() > 1 && mark == 0) return (point.array() == 0).all();
  return (point.array() == mark).any();
}

// The number that all coordinates of a point have.
std::optional<double> only_number(const Samples& point) {
  const double first = point[0];
  if (!std::isfinite(first) || (point.array() != first).any()) return std::nullopt;
  return first;
}

// Frames in which a number stands for whole joints, and one of the joints.
struct Recurrence {
  Index count = 0;
  std::string joint;
};

bool is_usual(double number) { return std::ranges::find(usual_marks, number) != usual_marks.end(); }

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
};

// Of all samples but those that are `left_out`.
Range range_of(const Recording& recording, std::optional<double> left_out) {
  Range range;
  for (const double sample : recording.samples.reshaped())
    if (std::isfinite(sample) && sample != left_out) {
      range.least = std::min(range.least, sample);
      range.most = std::max(range.most, sample);
    }
  return range;
}

// Whether a number lies farther from all other samples than these are apart.
bool is_far_out(const Recording& recording, double number) {
  const auto [least, most] = range_of(recording, number);
  const double extent = most - least;
  return number < least - extent || number > most + extent;
}

// The usual marks, and of points those at an end of the range: only they can lie far out.
std::map<double, Recurrence> recurrences(const Recording& recording) {
  const Range range = range_of(recording, std::nullopt);
  std::map<double, Recurrence> found;
  for (const Joint& joint : joints(recording)) {
    std::map<double, Index> own;
    for (Index f = 0; f < recording.frames(); ++f) {
      const auto number =
          only_number(recording.samples.row(f).segment(joint.first_column, joint.columns));
      if (!number || *number == 0) continue;
      const bool is_end = *number == range.least || *number == range.most;
      if (is_usual(*number) || (is_end && joint.columns > 1)) ++own[*number];
    }
    for (const auto& [number, count] : own) {
      if (count < fewest_frames || count == recording.frames()) continue;
      Recurrence& all = found[number];
      all.count += count;
      if (all.joint.empty()) all.joint = joint.name;
    }
  }
  return found;
}

}  // namespace

void apply_missing_marks(const std::vector<double>& marks, Recording& recording) {
  if (marks.empty()) return;
  for (const Joint& joint : joints(recording))
    for (Index f = 0; f < recording.frames(); ++f) {
      auto point = recording.samples.row(f).segment(joint.first_column, joint.columns);
      if (std::ranges::any_of(marks, [&](double mark) { return says(point, mark); }))
        point.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
}

void warn_of_marks(Recording& recording) {
  for (const auto& [number, recurrence] : recurrences(recording)) {
    if (!is_far_out(recording, number)) continue;
    recording.notes.warnings.push_back(
        fmt::format("{} stands in {} samples, first of {}, as if it meant a missing one; if so, "
                    "give --missing {}",
                    number, recurrence.count, recurrence.joint, number));
  }
}

}  // namespace moclean
