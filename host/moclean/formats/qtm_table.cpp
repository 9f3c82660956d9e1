#include <algorithm>
#include <cmath>
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

constexpr std::string_view qtm_start = "NO_OF_FRAMES";

// The table that Qualisys Track Manager exports: a line per setting, perhaps a line of column
// names, rows of three coordinates per marker, perhaps with a frame number and a time before them.
class QtmHead {
 public:
  explicit QtmHead(const TableText& table) : table_(table), lines_(table.text) {}

  TableShape shape() {
    shape_.dialect = "QTM TSV";
    shape_.separator =
        table_.text.substr(0, table_.text.find('\n')).find('\t') == std::string_view::npos ? ','
                                                                                           : '\t';
    shape_.unit = "mm";  // QTM exports no other
    settings();
    if (!has_row_) fail("expected rows of samples, found the end of the file");
    if (has_channels_)
      channels();
    else
      columns();
    return std::move(shape_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw FileError(table_.file, lines_.number(), problem);
  }

  // Up to the first line that has no setting: its name is in capitals, behind MARKER_NAMES with
  // underscores (columns may be called in capitals, too). EVENT lines stand among them.
  void settings() {
    while (lines_.next()) {
      if (lines_.line().empty()) continue;
      TableCells cells(lines_.line(), shape_.separator);
      cells.next();
      const std::string name = unquoted(cells);
      const bool is_setting = name.size() > 2 &&
                              name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_") == name.npos &&
                              (markers_.empty() || name.find('_') != name.npos || name == "EVENT" ||
                               name == "FREQUENCY" || name == "DESCRIPTION");
      if (!is_setting) {
        has_row_ = true;
        return;
      }
      if (cells.next()) setting(name, cells.text());
    }
  }

  void setting(const std::string& name, std::string_view value) {
    const TextSpan span{static_cast<std::size_t>(value.data() - table_.text.data()), value.size()};
    if (name == qtm_start) shape_.count_texts.push_back(span);
    if (name == "FREQUENCY") {
      if (!table_number(value, '.', shape_.rate) || !(shape_.rate > 0 && shape_.rate < 1e9))
        fail(fmt::format("expected a FREQUENCY in Hz, found {}", excerpt(value)));
      shape_.rate_text = span;
    }
    if (name == "DATA_INCLUDED" && value != "3D") {
      if (value.ends_with('D') || value.ends_with('d'))
        fail(
            fmt::format("expected positions of markers (DATA_INCLUDED 3D), found {}: neither rigid "
                        "bodies (6D) nor pictures of cameras (2D) are read",
                        excerpt(value)));
      has_channels_ = true;  // Angle, Velocity and so on, calculated from markers
    }
    if (name == "MARKER_NAMES") {
      markers_ = cells_of_line(lines_.line(), shape_.separator);
      markers_.erase(markers_.begin());
      markers_.resize(named_columns(markers_));
    }
  }

  // Results of calculations have a line of names.
  void channels() {
    const std::vector<std::string> names = cells_of_line(lines_.line(), shape_.separator);
    const NamedQuantity first = named_quantity(names[0]);
    if (first != NamedQuantity::frame && first != NamedQuantity::time)
      fail(fmt::format("expected Frame, Time and names, found {}", excerpt(lines_.line())));
    shape_.unit.clear();
    shape_.rows = lines_.position();
    shape_.first_line = lines_.number() + 1;
    shape_.least_cells = named_columns(names);
    shape_.roles = recognise_columns(names, first_values(table_.text, shape_, names.size()));
  }

  void columns() {
    if (markers_.empty()) fail("expected MARKER_NAMES above the rows, found none");
    std::vector<std::string> names = cells_of_line(lines_.line(), shape_.separator);
    names.resize(named_columns(names));
    double value = 0;
    const bool are_names =
        !names.empty() && !table_number(names.back(), '.', value) && !says_missing(names.back());
    // Without a line of names the last markers of the first row may be missing.
    const std::size_t coordinates = 3 * markers_.size();
    std::size_t before = names.size() > coordinates ? names.size() - coordinates : 0;
    if (are_names) before = names_before(names);
    if (before > 2 || (are_names && names.size() != before + coordinates))
      fail(
          fmt::format("expected X, Y, Z of {} markers, with Frame and Time before them or without, "
                      "found {} columns",
                      markers_.size(), names.size()));
    if (are_names) {
      shape_.rows = lines_.position();
      shape_.first_line = lines_.number() + 1;
    } else {
      shape_.rows = lines_.begin();
      shape_.first_line = lines_.number();
      names = before == 2 ? std::vector<std::string>{"Frame", "Time"}
                          : std::vector<std::string>(before, "Time");
      for (const std::string& marker : markers_)
        for (const char axis : {'X', 'Y', 'Z'}) names.push_back(fmt::format("{} {}", marker, axis));
    }
    shape_.least_cells = names.size();
    TablePoints points(names);
    if (before > 0) points.set(before - 1, ColumnRole::time);
    if (before == 2) points.set(0, ColumnRole::index);
    if (before == 1 && in_lower_case(names[0]).starts_with("frame"))
      points.set(0, ColumnRole::index);
    for (std::size_t i = 0; i < coordinates; ++i)
      points.coordinate(before + i, fmt::to_string(i / 3), markers_[i / 3], i % 3);
    shape_.roles = points.roles();
  }

  static std::size_t names_before(const std::vector<std::string>& names) {
    std::size_t count = 0;
    for (; count < names.size(); ++count) {
      const NamedQuantity quantity = named_quantity(names[count]);
      if (quantity != NamedQuantity::time && quantity != NamedQuantity::frame) break;
    }
    return count;
  }

  const TableText& table_;
  TextLines lines_;
  TableShape shape_;
  std::vector<std::string> markers_;
  bool has_row_ = false, has_channels_ = false;
};

}  // namespace

std::optional<TableShape> qtm_shape(const TableText& table) {
  if (!table.text.starts_with(qtm_start)) return std::nullopt;
  return QtmHead(table).shape();
}

}  // namespace moclean
