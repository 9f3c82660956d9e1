#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/column_names.hpp"
#include "moclean/formats/table_cells.hpp"
#include "moclean/formats/table_number.hpp"
#include "moclean/formats/table_points.hpp"
#include "moclean/formats/table_shape.hpp"
#include "moclean/formats/text_lines.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

constexpr std::array<std::string_view, 8> sections = {"trajectories", "model outputs", "devices",
                                                      "events",       "segments",      "joints",
                                                      "analog data",  "analog"};

bool is_blank_row(std::string_view line) {
  return line.find_first_not_of(" ,;\t") == std::string_view::npos;
}

// The section that a line begins, in lower case; empty if it begins none.
std::string section_of(std::string_view line) {
  const std::size_t last = line.find_last_not_of(" ,;\t\"");
  if (last == std::string_view::npos) return {};
  const std::string word = in_lower_case(line.substr(line.starts_with('"') ? 1 : 0, last + 1));
  return std::ranges::find(sections, word) == sections.end() ? std::string() : word;
}

// The file that Vicon Nexus exports: tables one below the other, each under a line with its name,
// one with its rate, names, axes and units.
class NexusHead {
 public:
  explicit NexusHead(const TableText& table) : table_(table), lines_(table.text) {}

  TableShape shape() {
    shape_.dialect = "Nexus CSV";
    if (!find_trajectories())
      throw FileError(table_.file,
                      fmt::format("expected a table Trajectories, found {}", others()));
    rate();
    columns();
    rows();
    return std::move(shape_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw FileError(table_.file, lines_.number(), problem);
  }

  std::string others() const {
    std::string text;
    for (const std::string& part : shape_.other_parts) text += (text.empty() ? "" : ", ") + part;
    return text;
  }

  // Moves to the line `Trajectories`, if there is one, and collects the others.
  bool find_trajectories() {
    std::optional<TextLines> found;
    while (lines_.next()) {
      const std::string section = section_of(lines_.line());
      if (section == "trajectories" && !found)
        found = lines_;
      else if (!section.empty())
        shape_.other_parts.push_back("table " + section);
    }
    if (found) lines_ = *found;
    return found.has_value();
  }

  void expect_line(std::string_view what) {
    if (!lines_.next()) fail(fmt::format("expected {}, found the end of the file", what));
  }

  void rate() {
    expect_line("the rate in Hz");
    TableCells cells(lines_.line(), ',');
    cells.next();
    std::string_view value = cells.text();
    value = value.substr(0, value.find_first_of(";\t"));
    if (!table_number(value, '.', shape_.rate) || !(shape_.rate > 0 && shape_.rate < 1e9))
      fail(fmt::format("expected the rate in Hz, found {}", excerpt(lines_.line())));
    shape_.rate_text =
        TextSpan{static_cast<std::size_t>(value.data() - table_.text.data()), value.size()};
  }

  void columns() {
    expect_line("names of trajectories");
    const std::string_view names_line = lines_.line();
    for (const char candidate : {'\t', ';', ','})
      if (names_line.find(candidate) != names_line.npos) shape_.separator = candidate;
    std::vector<std::string> names = cells_of_line(names_line, shape_.separator);
    expect_line("Frame, Sub Frame, X, Y, Z ...");
    const std::vector<std::string> axes = cells_of_line(lines_.line(), shape_.separator);
    const std::string first = in_lower_case(axes[0]);
    if (axes.size() < 4 || !(first.starts_with("frame") || first.starts_with("field")))
      fail(fmt::format("expected Frame, Sub Frame, X, Y, Z ..., found {}", excerpt(lines_.line())));
    names.resize(axes.size());
    shape_.least_cells = named_columns(axes);
    std::string name;  // stands over the first of its columns only
    std::vector<std::string> owners;
    for (const std::string& cell : names) owners.push_back(cell.empty() ? name : name = cell);
    for (std::size_t c = 0; c < axes.size(); ++c)
      names[c] = owners[c].empty() ? axes[c] : fmt::format("{} {}", owners[c], axes[c]);
    TablePoints points(names);
    points.set(0, ColumnRole::index);
    for (std::size_t c = 1; c < axes.size(); ++c)
      if (const std::size_t axis = axis_of_cell(axes[c]); axis < 3 && !owners[c].empty())
        points.coordinate(c, owners[c], owners[c], axis);
    shape_.roles = points.roles();
    if (shape_.roles.points.empty()) fail("expected X, Y, Z of trajectories, found none");
  }

  void rows() {
    TextLines next = lines_;
    if (next.next()) units(next);
    shape_.rows = lines_.position();
    shape_.first_line = lines_.number() + 1;
    while (lines_.next())
      if (is_blank_row(lines_.line()) || !section_of(lines_.line()).empty()) {
        shape_.rows_end = lines_.begin();
        return;
      }
  }

  // A line of units, if the next one has no frame number.
  void units(const TextLines& line) {
    const std::vector<std::string> cells = cells_of_line(line.line(), shape_.separator);
    if (!cells[0].empty()) return;
    lines_ = line;
    for (const ColumnPoint& point : shape_.roles.points)
      if (point.columns[0] < cells.size() && shape_.unit.empty())
        shape_.unit = cells[point.columns[0]];
  }

  const TableText& table_;
  TextLines lines_;
  TableShape shape_;
};

// Whether a line with the name of a section is followed by its rate and names, since a table of one
// column may be named so; behind a title the line of axes, too, has to be one.
bool begins_section(TextLines lines, bool has_title) {
  if (section_of(lines.line()).empty() || !lines.next()) return false;
  double rate = 0;
  const std::string_view cell = lines.line().substr(0, lines.line().find_first_of(",;\t"));
  if (!table_number(cell, '.', rate)) return false;
  if (lines.next() && lines.line().find_first_of(",;\t") == std::string_view::npos) return false;
  if (!has_title) return true;
  if (!lines.next()) return false;
  const std::string axes = in_lower_case(lines.line().substr(0, 5));
  return axes == "frame" || axes == "field";
}

}  // namespace

std::optional<TableShape> nexus_shape(const TableText& table) {
  constexpr std::size_t longest_title = 12;  // lines Title, Date and so on of older versions
  TextLines lines(table.text);
  for (std::size_t n = 0; n < longest_title && lines.next();) {
    if (is_blank_row(lines.line())) continue;
    if (begins_section(lines, n > 0)) return NexusHead(table).shape();
    ++n;
  }
  return std::nullopt;
}

}  // namespace moclean
