#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "moclean/formats/column_names.hpp"
#include "moclean/formats/column_roles.hpp"

namespace moclean {

/// Collects the points of a table whose head says, column by column, which point and coordinate a
/// column is.
class TablePoints {
 public:
  /// All columns pass through until they are named. `names` is for messages.
  explicit TablePoints(std::vector<std::string> names) {
    roles_.roles.assign(names.size(), ColumnRole::other);
    roles_.names = std::move(names);
  }

  void set(std::size_t column, ColumnRole role) { roles_.roles[column] = role; }

  /// Column `column` is coordinate 0, 1 or 2 of the point that `key` stands for.
  void coordinate(std::size_t column, const std::string& key, const std::string& name,
                  std::size_t axis) {
    auto& point = points_[key];
    if (point.columns.empty()) point.columns.assign(3, none);
    if (point.columns[axis] != none) return;
    point.name = name;
    point.columns[axis] = column;
  }

  void confidence(std::size_t column, const std::string& key) {
    set(column, ColumnRole::confidence);
    points_[key].confidence = column;
  }

  /// What was collected; points without x or y are left out, and names that come again numbered.
  ColumnRoles roles() {
    for (auto& [key, point] : points_) {
      std::erase(point.columns, none);
      if (point.columns.size() < 2) continue;
      for (const std::size_t c : point.columns) set(c, ColumnRole::coordinate);
      roles_.points.push_back(std::move(point));
    }
    std::ranges::sort(roles_.points, {},
                      [](const ColumnPoint& point) { return std::ranges::min(point.columns); });
    DistinctNames distinct;
    for (ColumnPoint& point : roles_.points) point.name = distinct(point.name);
    return std::move(roles_);
  }

  bool empty() const { return points_.empty(); }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  ColumnRoles roles_;
  std::map<std::string, ColumnPoint> points_;
};

/// 0, 1, 2 of a cell that is x, y or z in any case; 3 of another.
inline std::size_t axis_of_cell(const std::string& cell) {
  if (cell.size() != 1) return 3;
  const std::size_t axis = std::string("xyz").find(static_cast<char>(cell[0] | 0x20));
  return std::min<std::size_t>(axis, 3);
}

}  // namespace moclean
