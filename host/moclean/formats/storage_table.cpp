#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/column_names.hpp"
#include "moclean/formats/table_cells.hpp"
#include "moclean/formats/table_shape.hpp"
#include "moclean/formats/text_lines.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

constexpr std::size_t longest_head = 200;  // lines

std::string_view without_space(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// A setting of the head, `nRows=3` or `datarows 3`.
std::pair<std::string, std::string_view> storage_setting(std::string_view line) {
  const std::size_t end = line.find_first_of("= \t");
  if (end == std::string_view::npos) return {};
  return {in_lower_case(line.substr(0, end)), without_space(line.substr(end + 1))};
}

bool has_tab(std::string_view line) { return line.find('\t') != std::string_view::npos; }

}  // namespace

// OpenSim's storage (.sto) and motion (.mot) files: a head up to `endheader`, a line of names,
// rows.
std::optional<TableShape> storage_shape(const TableText& table) {
  const bool must_be = table.extension == ".mot" || table.extension == ".sto";
  TextLines lines(table.text);
  TableShape shape;
  shape.dialect = "OpenSim storage";
  bool is_found = false;
  for (std::size_t n = 0; !is_found && n < longest_head && lines.next(); ++n) {
    const std::string_view line = without_space(lines.line());
    is_found = in_lower_case(line) == "endheader";
    const auto [name, value] = storage_setting(line);
    if (name == "nrows" || name == "datarows")
      shape.count_texts.push_back(
          {static_cast<std::size_t>(value.data() - table.text.data()), value.size()});
    if (name == "indegrees")
      shape.dialect +=
          in_lower_case(value) == "yes" ? ", angles in degrees" : ", angles in radians";
    if (name == "datatype" && in_lower_case(value) != "double" && (must_be || value == "Vec3"))
      throw FileError(
          table.file, lines.number(),
          fmt::format("expected DataType=double, a number per cell, found {}", excerpt(value)));
  }
  const auto fail = [&](const std::string& problem) {
    throw FileError(table.file, std::max<std::size_t>(1, lines.number()), problem);
  };
  if (!is_found && must_be) fail("expected a head that ends with a line endheader, found none");
  if (!is_found) return std::nullopt;
  do
    if (!lines.next()) fail("expected a line of column names, found the end of the file");
  while (without_space(lines.line()).empty());
  TextLines row = lines;
  const bool are_tabs = has_tab(lines.line()) && row.next() && has_tab(row.line());
  shape.separator = are_tabs ? '\t' : between_words;
  const std::vector<std::string> names = cells_of_line(lines.line(), shape.separator);
  shape.rows = lines.position();
  shape.first_line = lines.number() + 1;
  shape.least_cells = named_columns(names);
  shape.roles = recognise_columns(names, first_values(table.text, shape, names.size()));
  return shape;
}

}  // namespace moclean
