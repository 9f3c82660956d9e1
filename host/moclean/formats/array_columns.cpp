#include "moclean/formats/array_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/column_roles.hpp"

namespace moclean {
namespace {

using Shape = std::vector<std::uint64_t>;

constexpr std::array<std::string_view, 3> axis_suffixes = {".x", ".y", ".z"};

std::string text_of(const Shape& shape) {
  std::string text;
  for (const std::uint64_t extent : shape)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", extent);
  return shape.size() == 1 ? text + "," : text;
}

// The least and largest number of one component of all points, and how many there are.
struct Extent {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  double size() const { return most - least; }
};

Extent extent_of(const Matrix& numbers, Index component, Index width) {
  Extent extent;
  for (Index f = 0; f < numbers.rows(); ++f)
    for (Index c = component; c < numbers.cols(); c += width) {
      const double number = numbers(f, c);
      if (!std::isfinite(number)) continue;
      extent.least = std::min(extent.least, number);
      extent.most = std::max(extent.most, number);
    }
  return extent;
}

bool is_confidence(const Matrix& numbers, Index component, Index width) {
  const Extent extent = extent_of(numbers, component, width);
  return extent.least >= 0 && extent.most <= 1;
}

// x and y in pixels beside a number within 0 to 1.
bool is_picture_with_confidence(const Matrix& numbers) {
  constexpr double smallest_picture = 50;
  return is_confidence(numbers, 2, 3) && extent_of(numbers, 0, 3).size() > smallest_picture &&
         extent_of(numbers, 1, 3).size() > smallest_picture;
}

// Whether all groups of four numbers have length 1, and not for being 0, 0, 0, 1.
bool are_unit_quaternions(const Matrix& numbers) {
  constexpr double rounding = 1e-3;
  Index others = 0;
  for (Index f = 0; f < numbers.rows(); ++f)
    for (Index c = 0; c < numbers.cols(); c += 4) {
      const auto quaternion = numbers.row(f).segment<4>(c);
      if (!quaternion.allFinite()) continue;
      if (std::abs(quaternion.norm() - 1) > rounding) return false;
      others += quaternion.head<3>().norm() > rounding;
    }
  return others > 0;
}

double mean_step(const Matrix& numbers, Index rows_apart, Index columns_apart) {
  double sum = 0;
  Index count = 0;
  for (Index f = 0; f + rows_apart < numbers.rows(); ++f)
    for (Index c = 0; c + columns_apart < numbers.cols(); ++c) {
      const double step = numbers(f + rows_apart, c + columns_apart) - numbers(f, c);
      if (!std::isfinite(step)) continue;
      sum += std::abs(step);
      ++count;
    }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

// Whether neighbours along the second axis are far closer to each other than along the first.
bool looks_transposed(const Shape& shape, const Matrix& numbers) {
  constexpr std::uint64_t times_longer = 3;
  constexpr double times_smoother = 4;
  if (shape[1] < times_longer * shape[0]) return false;
  const auto width = static_cast<Index>(shape[2]);
  const double along_first = mean_step(numbers, 1, 0), along_second = mean_step(numbers, 0, width);
  return times_smoother * along_second < along_first;
}

std::string point_name(Index point, std::size_t axis) {
  return fmt::format("joint{}{}", point, axis_suffixes[axis]);
}

ArrayColumns plain(Index columns) {
  ArrayColumns found;
  for (Index c = 0; c < columns; ++c) {
    found.samples.push_back(c);
    found.names.push_back(fmt::format("column{}", c));
    found.confidences.push_back(-1);
  }
  return found;
}

// Points of `width` numbers, the first `axes` of which are coordinates and the next a confidence.
ArrayColumns points(Index columns, Index width, Index axes) {
  ArrayColumns found;
  for (Index first = 0; first < columns; first += width) {
    for (Index a = 0; a < axes; ++a) {
      found.samples.push_back(first + a);
      found.names.push_back(point_name(first / width, static_cast<std::size_t>(a)));
      found.confidences.push_back(width > axes ? first + axes : -1);
    }
    if (width > axes)
      found.notes.passed_through.push_back(fmt::format("joint{} confidence", first / width));
  }
  return found;
}

std::string points_text(Index columns, Index width, Index axes, std::string_view more) {
  return fmt::format("{} points of {} coordinates{}", columns / width, axes == 3 ? "three" : "two",
                     more);
}

// As --layout says.
ArrayColumns as_told(const Shape& shape, Index columns, const std::filesystem::path& file,
                     const ReadOptions& options) {
  if (options.layout == ColumnLayout::plain) {
    ArrayColumns found = plain(columns);
    found.notes.layout = fmt::format("{} plain channels (--layout)", columns);
    return found;
  }
  const Index axes = options.layout == ColumnLayout::points3 ? 3 : 2;
  if (columns % axes != 0)
    throw FileError(file, fmt::format("an array ({}) of {} columns holds no points of {} "
                                      "coordinates (--layout)",
                                      text_of(shape), columns, axes));
  ArrayColumns found = points(columns, axes, axes);
  found.notes.layout = points_text(columns, axes, axes, " (--layout)");
  return found;
}

// As --columns says.
ArrayColumns as_specified(Index columns, const std::string& specification) {
  const ColumnRoles roles = parse_column_roles(specification, plain(columns).names);
  ArrayColumns found;
  found.names = roles.sample_names();
  std::vector<Index> confidence_of(static_cast<std::size_t>(columns), -1);
  for (const ColumnPoint& point : roles.points)
    for (const std::size_t c : point.columns)
      if (point.confidence) confidence_of[c] = static_cast<Index>(*point.confidence);
  std::vector<bool> is_sample(static_cast<std::size_t>(columns), false);
  for (const std::size_t c : roles.sample_columns()) {
    found.samples.push_back(static_cast<Index>(c));
    found.confidences.push_back(confidence_of[c]);
    is_sample[c] = true;
  }
  for (std::size_t c = 0; c < is_sample.size(); ++c)
    if (!is_sample[c]) found.notes.passed_through.push_back(roles.shown(c));
  found.notes.layout = roles.described() + " (--columns)";
  return found;
}

ArrayColumns of_rows(const Shape& shape, Index columns) {
  const bool has_points = columns % 3 == 0;
  ArrayColumns found = has_points ? points(columns, 3, 3) : plain(columns);
  const std::string what =
      has_points ? points_text(columns, 3, 3, "") : fmt::format("{} plain channels", columns);
  found.notes.layout = fmt::format("{} (an array of shape ({}): 3 {} its columns)", what,
                                   text_of(shape), has_points ? "divides" : "does not divide");
  return found;
}

ArrayColumns of_points(const Shape& shape, const Matrix& numbers,
                       const std::filesystem::path& file) {
  const Index columns = numbers.cols(), width = static_cast<Index>(shape[2]);
  const std::string where = fmt::format(" (an array of shape ({}))", text_of(shape));
  if (width == 4 && are_unit_quaternions(numbers))
    throw FileError(file, fmt::format("the shape ({}) and numbers of length 1 are unit "
                                      "quaternions, no positions; --layout plain cleans the "
                                      "numbers as they are, without keeping their length",
                                      text_of(shape)));
  ArrayColumns found;
  if (width == 3 && is_picture_with_confidence(numbers)) {
    found = points(columns, 3, 2);
    found.notes.layout =
        points_text(columns, 3, 2, " and a confidence within 0 to 1, which weighs them") + where;
  } else if (width == 4 && is_confidence(numbers, 3, 4)) {
    found = points(columns, 4, 3);
    found.notes.layout =
        points_text(columns, 4, 3, " and a confidence within 0 to 1, which weighs them") + where;
  } else if (width == 2 || width == 3) {
    found = points(columns, width, width);
    found.notes.layout = points_text(columns, width, width, where);
  } else {
    found = plain(columns);
    found.notes.layout = fmt::format("{} plain channels{}", columns, where);
    found.notes.warnings.push_back(
        fmt::format("the last axis of the shape ({}) is not 2 or 3 coordinates: cleaned as plain "
                    "channels",
                    text_of(shape)));
  }
  if (looks_transposed(shape, numbers))
    found.notes.warnings.push_back(
        fmt::format("the second axis of the shape ({}) looks like time, not the first; if it is, "
                    "save array.swapaxes(0, 1)",
                    text_of(shape)));
  return found;
}

}  // namespace

void require_readable_shape(const Shape& shape, const std::filesystem::path& file) {
  const std::string text = text_of(shape);
  if (shape.empty() || std::ranges::find(shape, 0U) != shape.end())
    throw FileError(file, "expected frames and columns, found an array of shape (" +
                              (shape.empty() ? "" : text) + ")");
  const auto refuse = [&](std::string_view problem) {
    throw FileError(file,
                    fmt::format("expected an array (frames, points, 3), found the shape ({}): "
                                "{}",
                                text, problem));
  };
  const auto are_axes = [](std::uint64_t extent) { return extent >= 2 && extent <= 4; };
  if (shape.size() == 4 && shape[2] == 3 && shape[3] == 3)
    refuse("rotation matrices? They are no positions");
  if (shape.size() >= 4 && shape[0] == 1) refuse("a batch of one take? Save array[0]");
  if (shape.size() == 4 && shape[1] == 1) refuse("one person per frame? Save array[:, 0]");
  if (shape.size() >= 4) refuse("a batch of takes, or several persons? Save one array for each");
  if (shape.size() != 3 || are_axes(shape[2])) return;
  if (are_axes(shape[0]) && shape[2] > 1)
    refuse("(axes, points, frames)? Save array.transpose(2, 1, 0), of three coordinates");
  if (are_axes(shape[1]) && shape[2] > 9)
    refuse("(frames, axes, points)? Save array.transpose(0, 2, 1)");
}

ArrayColumns columns_of_array(const Shape& shape, const Matrix& numbers,
                              const std::filesystem::path& file, const ReadOptions& options) {
  require_readable_shape(shape, file);
  const Index columns = numbers.cols();
  if (!options.columns.empty()) return as_specified(columns, options.columns);
  if (options.layout != ColumnLayout::automatic) return as_told(shape, columns, file, options);
  return shape.size() == 3 && shape[2] > 1 ? of_points(shape, numbers, file)
                                           : of_rows(shape, columns);
}

}  // namespace moclean
