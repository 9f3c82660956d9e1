#include "moclean/formats/column_roles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "moclean/formats/column_names.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

bool is_empty(const Matrix& rows, std::size_t column) {
  return rows.rows() == 0 || rows.col(static_cast<Index>(column)).array().isNaN().all();
}

// Whole numbers, each above the one before: frames may have been left out.
bool counts(const Matrix& rows, std::size_t column) {
  if (rows.rows() < 2) return false;
  const auto values = rows.col(static_cast<Index>(column));
  for (Index r = 0; r < rows.rows(); ++r)
    if (values[r] != std::floor(values[r]) || (r > 0 && !(values[r] > values[r - 1]))) return false;
  return true;
}

// Columns that one reading of names makes a point.
struct AxisGroup {
  std::array<std::vector<std::size_t>, 4> columns;  // w, x, y, z
  std::string point, remark;
  NameStyle style = NameStyle::suffix;
  const std::vector<std::size_t>& of(char axis) const {
    return columns[static_cast<std::size_t>(axis - 'w')];
  }
};

// The groups in the order of styles, and of their first columns.
std::vector<AxisGroup> axis_groups(const std::vector<std::string>& names,
                                   const std::vector<ColumnRole>& roles) {
  std::map<std::tuple<NameStyle, char, std::string, std::string>, std::size_t> places;
  std::vector<AxisGroup> groups;
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (roles[c] == ColumnRole::time || roles[c] == ColumnRole::index) continue;
    for (AxisName& axis : axis_names(names[c])) {
      const auto [place, is_new] =
          places.try_emplace({axis.style, axis.joint, axis.point, axis.remark}, groups.size());
      if (is_new) groups.push_back({{}, std::move(axis.point), std::move(axis.remark), axis.style});
      groups[place->second].columns[static_cast<std::size_t>(axis.axis - 'w')].push_back(c);
    }
  }
  std::ranges::stable_sort(groups, {}, &AxisGroup::style);
  return groups;
}

class RoleFinder {
 public:
  RoleFinder(const std::vector<std::string>& names, const Matrix& first_rows)
      : names_(names), first_rows_(first_rows) {
    found_.names = names;
    found_.roles.assign(names.size(), ColumnRole::plain);
    is_taken_.assign(names.size(), false);
    for (const std::string& name : names) quantities_.push_back(named_quantity(name));
  }

  ColumnRoles find() {
    times_and_indices();
    const std::vector<AxisGroup> groups = axis_groups(names_, found_.roles);
    for (const AxisGroup& group : groups) leave_out(group);
    const bool are_places = translations_are_places(groups);
    for (const AxisGroup& group : groups)
      if (group.style != NameStyle::shifted || are_places) points_of_three(group);
    for (const AxisGroup& group : groups)
      if (group.style != NameStyle::shifted) points_of_two(group);
    std::ranges::sort(found_.points, {},
                      [](const ColumnPoint& point) { return std::ranges::min(point.columns); });
    name_points();
    confidences();
    rest();
    return std::move(found_);
  }

 private:
  void times_and_indices() {
    bool has_time = false;
    for (std::size_t c = 0; c < names_.size(); ++c) {
      switch (quantities_[c]) {
        case NamedQuantity::time:
          take(c, has_time ? ColumnRole::other : ColumnRole::time);
          has_time = true;
          break;
        case NamedQuantity::frame:
          take(c, ColumnRole::index);
          break;
        case NamedQuantity::running:
          if (counts(first_rows_, c)) take(c, ColumnRole::index);
          break;
        default:
          break;
      }
    }
  }

  void take(std::size_t column, ColumnRole role) {
    found_.roles[column] = role;
    is_taken_[column] = true;
  }

  bool is_free(const std::vector<std::size_t>& columns) const {
    return std::ranges::none_of(columns, [&](std::size_t c) { return is_taken_[c]; });
  }

  // Quaternions, boxes (x, y, width, height), and sets whose names tell of something else than
  // places.
  void leave_out(const AxisGroup& group) {
    const bool has_w = !group.of('w').empty();
    NamedQuantity quantity = named_quantity(group.point);
    if (group.style == NameStyle::glued && quantity == NamedQuantity::none)
      quantity = quantity_of_letter(group.point);
    const bool is_vector = quantity == NamedQuantity::rate_of_change;
    if (!has_w && !is_vector && quantity != NamedQuantity::angle) return;
    for (const auto& columns : group.columns)
      for (const std::size_t c : columns) {
        left_out_.insert(c);
        const bool is_angle =
            !is_vector && (quantity == NamedQuantity::angle || !group.of('z').empty());
        if (is_angle) found_.roles[c] = ColumnRole::angle;
      }
  }

  // `pelvis_tx` among joint angles is a channel as they are; where at least half of the columns are
  // named so, they are places.
  bool translations_are_places(const std::vector<AxisGroup>& groups) const {
    std::size_t count = 0;
    for (const AxisGroup& group : groups) {
      if (group.style != NameStyle::shifted) continue;
      count += 3 * std::min({group.of('x').size(), group.of('y').size(), group.of('z').size()});
    }
    const auto others = std::count(is_taken_.begin(), is_taken_.end(), false);
    return 2 * count >= static_cast<std::size_t>(others);
  }

  void points_of_three(const AxisGroup& group) {
    const auto &x = group.of('x'), &y = group.of('y'), &z = group.of('z');
    const std::size_t count = std::min({x.size(), y.size(), z.size()});
    for (std::size_t i = 0; i < count; ++i) add_point(group, {x[i], y[i], z[i]});
  }

  void points_of_two(const AxisGroup& group) {
    if (!group.of('z').empty()) return;
    const auto &x = group.of('x'), &y = group.of('y');
    for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) add_point(group, {x[i], y[i]});
  }

  void add_point(const AxisGroup& group, const std::vector<std::size_t>& columns) {
    if (!is_free(columns)) return;
    if (std::ranges::any_of(columns, [&](std::size_t c) { return left_out_.contains(c); })) return;
    if (found_.example.empty()) found_.example = names_[columns[0]];
    for (const std::size_t c : columns) take(c, ColumnRole::coordinate);
    found_.points.push_back({group.point, columns});
    if (!group.remark.empty()) remarks_[columns[0]] = group.remark;
  }

  // Points without a name are counted, names that come again get a number.
  void name_points() {
    const bool has_bare =
        std::ranges::any_of(found_.points, &std::string::empty, &ColumnPoint::name);
    DistinctNames distinct;
    std::unordered_map<std::string, int> counts;
    if (!remarks_.empty())
      for (const ColumnPoint& point : found_.points) ++counts[point.name];
    std::size_t number = 0;
    for (ColumnPoint& point : found_.points) {
      stems_.push_back(in_lower_case(point.name));
      ++number;
      // `nose_3d` and `nose_2d` are told apart by what else says nothing.
      const auto remark = remarks_.find(point.columns[0]);
      if (remark != remarks_.end() && counts[point.name] > 1) point.name += remark->second;
      const bool is_number = point.name.find_first_not_of("0123456789") == std::string::npos;
      if (is_number) point.name = has_bare ? fmt::format("point{}", number) : "point" + point.name;
      point.name = distinct(point.name);
    }
  }

  void confidences() {
    std::vector<std::pair<std::size_t, std::vector<std::string>>> judging;  // columns, whose points
    for (std::size_t c = 0; c < names_.size(); ++c) {
      if (is_taken_[c]) continue;
      if (std::vector<std::string> stems = points_judged_by(names_[c]); !stems.empty())
        judging.emplace_back(c, std::move(stems));
      if (quantities_[c] == NamedQuantity::confidence) take(c, ColumnRole::confidence);
    }
    if (judging.empty()) return;
    std::unordered_map<std::string, std::vector<std::size_t>> points;
    for (std::size_t p = stems_.size(); p-- > 0;) points[stems_[p]].push_back(p);
    for (const auto& [column, stems] : judging)
      for (const std::string& stem : stems) {
        const auto place = points.find(stem);
        if (place == points.end() || place->second.empty()) continue;
        found_.points[place->second.back()].confidence = column;
        place->second.pop_back();
        take(column, ColumnRole::confidence);
        break;
      }
  }

  void rest() {
    const bool has_points = !found_.points.empty();
    for (std::size_t c = 0; c < names_.size(); ++c) {
      if (is_taken_[c]) continue;
      const bool is_nothing = names_[c].empty() && is_empty(first_rows_, c);
      if (!has_points && !is_nothing)
        found_.roles[c] = ColumnRole::plain;
      else if (found_.roles[c] != ColumnRole::angle)
        found_.roles[c] =
            quantities_[c] == NamedQuantity::angle ? ColumnRole::angle : ColumnRole::other;
    }
  }

  const std::vector<std::string>& names_;
  const Matrix& first_rows_;
  ColumnRoles found_;
  std::vector<NamedQuantity> quantities_;  // that names tell of
  std::vector<bool> is_taken_;
  std::set<std::size_t> left_out_;
  std::unordered_map<std::size_t, std::string> remarks_;  // of the points that begin with a column
  std::vector<std::string> stems_;                        // of the points, in lower case
};

}  // namespace

std::vector<std::size_t> ColumnRoles::sample_columns() const {
  std::vector<std::pair<std::size_t, std::vector<std::size_t>>> items;
  for (const ColumnPoint& point : points)
    items.emplace_back(std::ranges::min(point.columns), point.columns);
  for (std::size_t c = 0; c < roles.size(); ++c)
    if (roles[c] == ColumnRole::plain) items.emplace_back(c, std::vector{c});
  std::ranges::sort(items);
  std::vector<std::size_t> columns;
  for (const auto& item : items)
    columns.insert(columns.end(), item.second.begin(), item.second.end());
  return columns;
}

std::vector<std::string> ColumnRoles::sample_names() const {
  std::vector<std::string> own = names;
  for (const ColumnPoint& point : points)
    for (std::size_t i = 0; i < point.columns.size(); ++i)
      own[point.columns[i]] = fmt::format("{}.{}", point.name, "xyz"[i]);
  std::vector<std::string> found;
  for (const std::size_t c : sample_columns()) found.push_back(std::move(own[c]));
  return found;
}

std::string ColumnRoles::shown(std::size_t column) const {
  return names[column].empty() ? fmt::format("column {}", column + 1) : names[column];
}

std::string ColumnRoles::described() const {
  const auto is_three = [](const ColumnPoint& point) { return point.columns.size() == 3; };
  const auto threes = static_cast<std::size_t>(std::ranges::count_if(points, is_three));
  const auto channels = static_cast<std::size_t>(std::ranges::count(roles, ColumnRole::plain));
  const auto counted = [](std::size_t count, std::string_view what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  std::string text;
  const auto add = [&](std::size_t count, std::string_view what, std::string_view which) {
    if (count == 0) return;
    text += fmt::format("{}{}{}", text.empty() ? "" : ", ", counted(count, what), which);
  };
  add(threes, "point", " of three coordinates");
  add(points.size() - threes, "point", " of two coordinates");
  if (!example.empty()) text += fmt::format(" (names like {})", excerpt(example));
  if (!points.empty()) add(channels, "channel", "");
  if (points.empty()) add(channels, "channel", "; no names tell of points");
  return text;
}

ColumnRoles recognise_columns(const std::vector<std::string>& names, const Matrix& first_rows) {
  return RoleFinder(names, first_rows).find();
}

}  // namespace moclean
