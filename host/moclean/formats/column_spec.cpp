#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/column_names.hpp"
#include "moclean/formats/column_roles.hpp"

namespace moclean {
namespace {

// Letters of a specification, group by group; it stops where there are far more than columns.
class SpecificationReader {
 public:
  SpecificationReader(std::string_view text, std::size_t width)
      : text_(text), width_(width), most_(10 * width + 1000) {}

  std::string letters() {
    std::string found = sequence(0);
    if (place_ < text_.size()) fail("a ( before this )");
    if (is_cut_) fail_count("far more");
    if (found.size() != width_) fail_count(fmt::to_string(found.size()));
    return found;
  }

 private:
  [[noreturn]] void fail(std::string_view expected) const {
    throw ArgumentError(
        fmt::format("--columns {}: expected {} at character {}", text_, expected, place_ + 1));
  }

  [[noreturn]] void fail_count(const std::string& found) const {
    throw ArgumentError(
        fmt::format("--columns {} tells of {} columns, there are {}", text_, found, width_));
  }

  std::string sequence(int depth) {
    constexpr int deepest = 16;
    if (depth > deepest) fail("fewer groups in each other");
    std::string found;
    for (skip_commas(); place_ < text_.size() && text_[place_] != ')'; skip_commas())
      item(depth, found);
    return found;
  }

  // Commas and blanks may stand between items, for whoever reads it.
  void skip_commas() {
    while (place_ < text_.size() && (text_[place_] == ',' || text_[place_] == ' ')) ++place_;
  }

  void item(int depth, std::string& found) {
    std::size_t times = 1;
    const char* const first = text_.data() + place_;
    const char* const last = text_.data() + text_.size();
    const bool has_count = *first >= '0' && *first <= '9';
    if (has_count) {
      const auto [after, error] = std::from_chars(first, last, times);
      if (error != std::errc() || times == 0) fail("a number of times above 0");
      place_ += static_cast<std::size_t>(after - first);
    }
    std::string part;
    if (place_ < text_.size() && text_[place_] == '(') {
      ++place_;
      part = sequence(depth + 1);
      if (place_ == text_.size()) fail(") behind a group");
      ++place_;
      if (part.empty()) fail("letters in a group");
    } else {
      if (place_ == text_.size() || letters_.find(text_[place_]) == letters_.npos)
        fail("one of t i x y z c p o, or a group in ( )");
      part = text_[place_++];
    }
    if (place_ < text_.size() && text_[place_] == '*') {
      ++place_;
      if (has_count || depth > 0 || place_ < text_.size())
        fail("a * behind the last group alone, without a number before it");
      times = found.size() < width_ ? (width_ - found.size() + part.size() - 1) / part.size() : 0;
    }
    for (; times > 0; --times) {
      if (found.size() > most_) {
        is_cut_ = true;
        return;
      }
      found += part;
    }
  }

  static constexpr std::string_view letters_ = "tixyzcpo";
  std::string_view text_;
  std::size_t width_, most_;
  std::size_t place_ = 0;
  bool is_cut_ = false;
};

// The name of a point by that of one of its columns; empty if it tells none.
std::string point_of(const std::string& name, char axis) {
  for (const AxisName& reading : axis_names(name))
    if (reading.axis == axis && reading.point.find_first_not_of("0123456789") != std::string::npos)
      return reading.point;
  return {};
}

// Makes points of coordinates that come one after the other.
class PointCollector {
 public:
  explicit PointCollector(const std::vector<std::string>& names) : names_(names) {}

  void coordinate(std::size_t column, char axis) {
    auto& own = open_[static_cast<std::size_t>(axis - 'x')];
    if (own) close();
    open_[static_cast<std::size_t>(axis - 'x')] = column;
  }

  void confidence(std::size_t column) {
    close();
    if (points_.empty() || points_.back().confidence)
      throw ArgumentError(
          fmt::format("--columns: c for column {} needs a point of its own before it", column + 1));
    points_.back().confidence = column;
  }

  std::vector<ColumnPoint> points() {
    close();
    return std::move(points_);
  }

 private:
  void close() {
    const auto& [x, y, z] = open_;
    if (!x && !y && !z) return;
    if (!x || !y)
      throw ArgumentError(
          fmt::format("--columns: point {} lacks its {}", points_.size() + 1, x ? 'y' : 'x'));
    ColumnPoint point{point_of(names_[*x], 'x'), {*x, *y}};
    if (z) point.columns.push_back(*z);
    if (point.name.empty()) point.name = fmt::format("point{}", points_.size() + 1);
    point.name = distinct_(point.name);
    points_.push_back(std::move(point));
    open_ = {};
  }

  const std::vector<std::string>& names_;
  std::array<std::optional<std::size_t>, 3> open_;
  std::vector<ColumnPoint> points_;
  DistinctNames distinct_;
};

ColumnRole role_of(char letter) {
  switch (letter) {
    case 't':
      return ColumnRole::time;
    case 'i':
      return ColumnRole::index;
    case 'c':
      return ColumnRole::confidence;
    case 'p':
      return ColumnRole::plain;
    case 'o':
      return ColumnRole::other;
    default:
      return ColumnRole::coordinate;
  }
}

ColumnRoles roles_of(std::string_view letters, const std::vector<std::string>& names) {
  ColumnRoles found{.roles = {}, .points = {}, .example = {}, .names = names};
  PointCollector points(names);
  for (std::size_t c = 0; c < letters.size(); ++c) {
    found.roles.push_back(role_of(letters[c]));
    if (found.roles.back() == ColumnRole::coordinate) points.coordinate(c, letters[c]);
    if (found.roles.back() == ColumnRole::confidence) points.confidence(c);
  }
  found.points = points.points();
  return found;
}

}  // namespace

ColumnRoles parse_column_roles(std::string_view specification,
                               const std::vector<std::string>& names) {
  const std::string letters = SpecificationReader(specification, names.size()).letters();
  if (std::ranges::count(letters, 't') > 1)
    throw ArgumentError(fmt::format("--columns {} has more than one time", specification));
  ColumnRoles found = roles_of(letters, names);
  if (found.sample_columns().empty())
    throw ArgumentError(fmt::format("--columns {} leaves no samples", specification));
  return found;
}

ColumnRoles columns_in_layout(ColumnLayout layout, const std::vector<std::string>& names,
                              const Matrix& first_rows) {
  const ColumnRoles by_name = recognise_columns(names, first_rows);
  std::string letters(names.size(), 'p');
  const std::size_t size = layout == ColumnLayout::points3 ? 3 : 2;
  std::size_t count = 0;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const ColumnRole role = by_name.roles[c];
    const bool is_empty = names[c].empty() && role == ColumnRole::other;
    if (role == ColumnRole::time)
      letters[c] = 't';
    else if (role == ColumnRole::index)
      letters[c] = 'i';
    else if (is_empty)
      letters[c] = 'o';
    else if (layout != ColumnLayout::plain)
      letters[c] = "xyz"[count++ % size];
  }
  if (count % size != 0)
    throw ArgumentError(
        fmt::format("--layout points{} needs a multiple of {} columns beside time "
                    "and index, there are {}",
                    size, size, count));
  return roles_of(letters, names);
}

}  // namespace moclean
