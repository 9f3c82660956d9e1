#include <algorithm>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/column_names.hpp"
#include "moclean/formats/table_cells.hpp"
#include "moclean/formats/table_rows.hpp"
#include "moclean/formats/table_shape.hpp"
#include "moclean/formats/text_lines.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

// Whether a column named so says which point, or whose, a row is.
bool names_points(const std::string& column) {
  std::string name = in_lower_case(column);
  std::erase_if(name,
                [](char c) { return std::string_view("._- ").find(c) != std::string_view::npos; });
  for (const std::string_view ending : {"name", "names", "id", "idx", "index", "label", "number"})
    if (name.size() > ending.size() + 2 && name.ends_with(ending))
      name.erase(name.size() - ending.size());
  for (const char* known :
       {"keypoint", "keypoints", "kpt",       "bodypart",   "bodyparts",   "marker",
        "markers",  "joint",     "joints",    "landmark",   "landmarks",   "point",
        "points",   "node",      "track",     "individual", "individuals", "person",
        "subject",  "animal",    "rigidbody", "body",       "object",      "identity"})
    if (name == known) return true;
  return false;
}

// The first line, counted from 1, whose cell in that column differs from that of the first row; 0
// if all are the same.
std::size_t line_of_another(std::string_view text, const TableShape& shape, std::size_t column) {
  std::optional<std::string> first;
  TextLines lines(text.substr(0, shape.rows_end), shape.rows, shape.first_line);
  while (lines.next()) {
    if (is_no_row(lines.line(), shape.separator)) continue;
    TableCells cells(lines.line(), shape.separator);
    for (std::size_t c = 0; c <= column; ++c)
      if (!cells.next()) return 0;
    if (!first)
      first = cells.text();
    else if (cells.text() != *first)
      return lines.number();
  }
  return 0;
}

// What pandas needs to make a column of every point.
std::string pivot(const ColumnRoles& roles, std::size_t key) {
  std::string index = "'frame'", values;
  for (std::size_t c = 0; c < roles.names.size(); ++c) {
    const NamedQuantity quantity = named_quantity(roles.names[c]);
    if (quantity == NamedQuantity::frame) index = excerpt(roles.names[c]);
    if (roles.roles[c] == ColumnRole::coordinate || roles.roles[c] == ColumnRole::confidence)
      values += (values.empty() ? "" : ", ") + excerpt(roles.names[c]);
  }
  return fmt::format("table.pivot(index={}, columns={}, values=[{}])", index,
                     excerpt(roles.names[key]), values);
}

}  // namespace

void refuse_long_table(const TableText& table, const TableShape& shape) {
  constexpr std::size_t most_points = 2;  // x, y, z, and perhaps those of the picture
  const ColumnRoles& roles = shape.roles;
  if (!shape.dialect.empty() || roles.points.empty() || roles.points.size() > most_points) return;
  const auto key = static_cast<std::size_t>(std::ranges::find_if(roles.names, names_points) -
                                            roles.names.begin());
  if (key == roles.names.size() || roles.roles[key] == ColumnRole::coordinate) return;
  const std::size_t line = line_of_another(table.text, shape, key);
  if (line == 0) return;
  throw FileError(table.file, line,
                  fmt::format("expected a row per frame, found a row per point, which column {} "
                              "({}) names: make columns of the points, in pandas with {}",
                              key + 1, excerpt(roles.names[key]), pivot(roles, key)));
}

}  // namespace moclean
