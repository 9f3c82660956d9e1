#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/column_names.hpp"
#include "moclean/formats/table_cells.hpp"
#include "moclean/formats/table_number.hpp"
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
       {"keypoint",  "keypoints", "kpt",        "kp",          "bodypart",  "bodyparts", "marker",
        "markers",   "joint",     "joints",     "landmark",    "landmarks", "point",     "points",
        "node",      "track",     "individual", "individuals", "person",    "subject",   "animal",
        "rigidbody", "body",      "object",     "identity"})
    if (name == known) return true;
  return false;
}

struct Row {
  std::size_t line = 0;
  std::vector<std::string_view> cells;
};

std::optional<std::size_t> column_of(const ColumnRoles& roles, NamedQuantity quantity) {
  const ColumnRole role = quantity == NamedQuantity::time ? ColumnRole::time : ColumnRole::index;
  for (std::size_t c = 0; c < roles.names.size(); ++c)
    if (roles.roles[c] == role && named_quantity(roles.names[c]) == quantity) return c;
  return std::nullopt;
}

std::optional<std::size_t> column_of_points(const ColumnRoles& roles) {
  for (std::size_t c = 0; c < roles.names.size(); ++c)
    if (names_points(roles.names[c]) && roles.roles[c] != ColumnRole::coordinate) return c;
  return std::nullopt;
}

// The first row, and the first of those below it whose cell in a column is the same, or is not.
std::optional<std::pair<Row, Row>> rows_that(bool are_same, std::string_view text,
                                             const TableShape& shape, std::size_t column) {
  constexpr std::size_t most_rows = 100000;  // whose cells in front of the column are looked at
  const auto row_of = [&](const TextLines& lines) {
    Row row{.line = lines.number(), .cells = {}};
    for (TableCells cells(lines.line(), shape.separator); cells.next();)
      row.cells.push_back(cells.text());
    row.cells.resize(std::max(row.cells.size(), shape.roles.names.size()));
    return row;
  };
  std::optional<Row> first;
  TextLines lines(text.substr(0, shape.rows_end), shape.rows, shape.first_line);
  for (std::size_t count = 0; count < most_rows && lines.next(); ++count) {
    if (is_no_row(lines.line(), shape.separator)) continue;
    if (!first) {
      first = row_of(lines);
      continue;
    }
    TableCells cells(lines.line(), shape.separator);
    for (std::size_t c = 0; c <= column && cells.next();) ++c;
    if ((cells.text() == first->cells[column]) == are_same)
      return std::pair(*std::move(first), row_of(lines));
  }
  return std::nullopt;
}

// The column in which two rows of one frame differ and that may tell whose they are: one of text,
// or one that is named so.
std::optional<std::size_t> key_of(const ColumnRoles& roles, const Row& first, const Row& other) {
  for (std::size_t c = 0; c < roles.names.size(); ++c) {
    const ColumnRole role = roles.roles[c];
    double value = 0;
    const bool may_tell = role == ColumnRole::other || role == ColumnRole::plain ||
                          (role == ColumnRole::index && names_points(roles.names[c]));
    if (!may_tell || first.cells[c] == other.cells[c]) continue;
    const bool is_text = !table_number(first.cells[c], '.', value) && !says_missing(first.cells[c]);
    if (is_text || names_points(roles.names[c])) return c;
  }
  return std::nullopt;
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
  constexpr std::size_t most_of_a_row = 2;  // x, y, z, and perhaps those of the picture
  const ColumnRoles& roles = shape.roles;
  if (!shape.dialect.empty()) return;
  const auto refuse = [&](std::size_t line, std::size_t key) {
    throw FileError(table.file, line,
                    fmt::format("expected a row per frame, found a row per point, which column {} "
                                "({}) names: make columns of the points, in pandas with {}",
                                key + 1, excerpt(roles.names[key]), pivot(roles, key)));
  };
  auto frame = column_of(roles, NamedQuantity::frame);
  if (!frame) frame = column_of(roles, NamedQuantity::time);
  if (frame) {
    const auto pair = rows_that(true, table.text, shape, *frame);
    const auto key = pair ? key_of(roles, pair->first, pair->second) : std::nullopt;
    if (key) refuse(pair->second.line, *key);
  }
  // Without repeated frames only a table of one point can be one, by the name of its column.
  if (roles.points.empty() || roles.points.size() > most_of_a_row) return;
  const auto key = column_of_points(roles);
  if (!key) return;
  const auto pair = rows_that(false, table.text, shape, *key);
  if (pair) refuse(pair->second.line, *key);
}

}  // namespace moclean
