#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/column_names.hpp"
#include "moclean/formats/table_cells.hpp"
#include "moclean/formats/table_points.hpp"
#include "moclean/formats/table_shape.hpp"
#include "moclean/formats/text_lines.hpp"

namespace moclean {
namespace {

bool is_pose_line(std::string_view word) {
  return word == "scorer" || word == "individuals" || word == "bodyparts" || word == "coords";
}

// The first cell of a line.
std::string first_word(std::string_view line) {
  TableCells cells(line, ',');
  cells.next();
  return unquoted(cells);
}

}  // namespace

// Tables of DeepLabCut, also of several animals and in space: two to four lines (scorer,
// individuals, bodyparts, coords) that say of every column whose it is.
std::optional<TableShape> pose_shape(const TableText& table) {
  TextLines lines(table.text);
  if (!lines.next() || !is_pose_line(first_word(lines.line()))) return std::nullopt;
  std::map<std::string, std::vector<std::string>> labels;
  do {
    std::vector<std::string> cells = cells_of_line(lines.line(), ',');
    const std::string word = cells[0];
    if (!is_pose_line(word)) break;
    labels[word] = std::move(cells);
    if (word == "coords") break;
  } while (lines.next());
  const std::vector<std::string>& coords = labels["coords"];
  const std::vector<std::string>& parts = labels["bodyparts"];
  std::vector<std::string>& individuals = labels["individuals"];
  if (coords.size() < 3 || parts.size() != coords.size()) {
    if (!labels.contains("scorer")) return std::nullopt;  // of another order: levels_shape()
    throw FileError(table.file, lines.number(),
                    "expected lines bodyparts and coords with a cell per column");
  }
  individuals.resize(coords.size());
  TableShape shape;
  shape.dialect = "DeepLabCut table";
  shape.rows = lines.position();
  shape.first_line = lines.number() + 1;
  shape.least_cells = coords.size();
  std::vector<std::string> owners, names;
  for (std::size_t c = 0; c < coords.size(); ++c) {
    owners.push_back(individuals[c].empty() || individuals[c] == "single"
                         ? parts[c]
                         : fmt::format("{}:{}", individuals[c], parts[c]));
    names.push_back(c == 0 ? "" : fmt::format("{} {}", owners[c], coords[c]));
  }
  TablePoints points(names);
  points.set(0, ColumnRole::index);
  for (std::size_t c = 1; c < coords.size(); ++c) {
    if (const std::size_t axis = axis_of_cell(coords[c]); axis < 3)
      points.coordinate(c, owners[c], owners[c], axis);
    else if (named_quantity(coords[c]) == NamedQuantity::confidence)
      points.confidence(c, owners[c]);
  }
  shape.roles = points.roles();
  if (shape.roles.points.empty())
    throw FileError(table.file, lines.number(), "expected coords x and y, found none");
  return shape;
}

}  // namespace moclean
