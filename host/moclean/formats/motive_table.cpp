#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
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

constexpr std::string_view motive_start = "Format Version,";

// The table that OptiTrack's Motive exports: a line of settings, and lines that say of every column
// type, name, id, parent, property and axis.
class MotiveHead {
 public:
  explicit MotiveHead(const TableText& table) : table_(table), lines_(table.text) {}

  TableShape shape() {
    shape_.dialect = "Motive CSV";
    lines_.next();
    settings();
    columns();
    shape_.rows = lines_.position();
    shape_.first_line = lines_.number() + 1;
    shape_.roles = roles();
    return std::move(shape_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw FileError(table_.file, lines_.number(), problem);
  }

  void settings() {
    TableCells cells(lines_.line(), ',');
    while (cells.next()) {
      const std::string name = in_lower_case(unquoted(cells));
      if (!cells.next()) break;
      const std::string_view value = cells.text();
      const TextSpan span{static_cast<std::size_t>(value.data() - table_.text.data()),
                          value.size()};
      if (name == "export frame rate" || (name == "capture frame rate" && shape_.rate == 0)) {
        if (!table_number(value, '.', shape_.rate) || !(shape_.rate > 0) ||
            !std::isfinite(shape_.rate))
          fail(fmt::format("expected a frame rate in Hz, found {}", excerpt(value)));
        shape_.rate_text = span;
      }
      if (name == "total exported frames") shape_.count_texts.push_back(span);
      if (name == "length units") shape_.unit = unit_of(std::string(value));
    }
  }

  static std::string unit_of(const std::string& word) {
    const std::string unit = in_lower_case(word);
    if (unit.starts_with("milli")) return "mm";
    if (unit.starts_with("centi")) return "cm";
    return unit.starts_with("meter") ? "m" : word;
  }

  void columns() {
    while (lines_.next()) {
      std::vector<std::string> cells = cells_of_line(lines_.line(), ',');
      if (cells.size() < 2) continue;
      if (cells[0] == "Frame") {
        axes_ = std::move(cells);
        return;
      }
      const std::string kind = in_lower_case(cells[1]);
      if (kind.empty())
        properties_ = std::move(cells);
      else
        labels_[kind] = std::move(cells);
    }
    fail("expected a line that begins with Frame, found the end of the file");
  }

  const std::string& label(const std::string& kind, std::size_t column) const {
    static const std::string nothing;
    const auto place = labels_.find(kind);
    return place == labels_.end() || column >= place->second.size() ? nothing
                                                                    : place->second[column];
  }

  ColumnRoles roles() {
    const std::size_t width = std::max({axes_.size(), properties_.size(), labels_["name"].size()});
    axes_.resize(width);
    properties_.resize(width);
    shape_.least_cells = width;
    std::vector<std::string> names = {axes_[0], axes_[1]};
    for (std::size_t c = 2; c < width; ++c)
      names.push_back(fmt::format("{} {} {}", label("name", c), properties_[c], axes_[c]));
    for (std::string& name : names) {
      name.erase(name.find_last_not_of(' ') + 1);
      name.erase(0, name.find_first_not_of(' '));  // TimeCode has nothing above it
    }
    TablePoints markers(names), expected(names), bodies(names);
    for (TablePoints* points : {&markers, &expected, &bodies}) {
      points->set(0, ColumnRole::index);
      if (in_lower_case(axes_[1]).starts_with("time")) points->set(1, ColumnRole::time);
    }
    for (std::size_t c = 2; c < width; ++c) position(c, markers, expected, bodies);
    for (TablePoints* points : {&markers, &expected, &bodies})
      if (!points->empty()) return points->roles();
    fail("expected positions of markers, found none");
  }

  // Measured markers are the points. Where they were not exported those are that Motive expects of
  // a body (`Rigid Body Marker`), which move with it, or else the bodies.
  void position(std::size_t c, TablePoints& markers, TablePoints& expected,
                TablePoints& bodies) const {
    const std::string type = in_lower_case(label("type", c));
    const std::size_t axis = axis_of_cell(axes_[c]);
    const std::string property = in_lower_case(properties_[c]);
    const bool is_expected = type != "marker" && type.find("marker") != std::string::npos;
    if (property.find("rotation") != std::string::npos)
      for (TablePoints* points : {&markers, &expected, &bodies}) points->set(c, ColumnRole::angle);
    if (axis > 2 || property != "position") return;
    const std::string& name = label("name", c);
    const std::string key = fmt::format("{}\t{}\t{}", type, name, label("id", c));
    TablePoints& own = type == "marker" ? markers : is_expected ? expected : bodies;
    own.coordinate(c, key, name, axis);
  }

  const TableText& table_;
  TextLines lines_;
  TableShape shape_;
  std::map<std::string, std::vector<std::string>> labels_;  // by the word in their second cell
  std::vector<std::string> properties_, axes_;
};

}  // namespace

std::optional<TableShape> motive_shape(const TableText& table) {
  if (!table.text.starts_with(motive_start)) return std::nullopt;
  return MotiveHead(table).shape();
}

}  // namespace moclean
