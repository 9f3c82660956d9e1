#include <algorithm>
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

constexpr std::size_t longest_head = 200;  // lines

std::string_view without_space(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return text.substr(text.size());  // a place all the same
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// Without the separators that a spreadsheet puts behind the lines of a head.
std::string_view without_separators(std::string_view text) {
  const std::size_t last = text.find_last_not_of(" \t,;");
  return without_space(text.substr(0, last == std::string_view::npos ? 0 : last + 1));
}

// A setting of the head, `nRows=3` or `datarows 3`.
std::pair<std::string, std::string_view> storage_setting(std::string_view line) {
  const std::size_t end = line.find_first_of("= \t");
  if (end == std::string_view::npos) return {};
  return {in_lower_case(line.substr(0, end)), without_space(line.substr(end + 1))};
}

class StorageHead {
 public:
  explicit StorageHead(const TableText& table)
      : table_(table),
        lines_(table.text),
        must_be_(table.extension == ".mot" || table.extension == ".sto") {
    shape_.dialect = "OpenSim storage";
  }

  std::optional<TableShape> shape() {
    if (!settings()) {
      if (must_be_) fail("expected a head that ends with a line endheader, found none");
      return std::nullopt;
    }
    do
      if (!lines_.next()) fail("expected a line of column names, found the end of the file");
    while (without_separators(lines_.line()).empty());
    if (has_vectors_)
      vectors();
    else
      numbers();
    return std::move(shape_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw FileError(table_.file, std::max<std::size_t>(1, lines_.number()), problem);
  }

  // Whether there is a head; moves behind it.
  bool settings() {
    for (std::size_t n = 0; n < longest_head && lines_.next(); ++n) {
      const std::string_view line = without_separators(lines_.line());
      if (in_lower_case(line) == "endheader") return true;
      const auto [name, value] = storage_setting(line);
      setting(name, value);
    }
    return false;
  }

  void setting(const std::string& name, std::string_view value) {
    const auto span = [&] {
      return TextSpan{static_cast<std::size_t>(value.data() - table_.text.data()), value.size()};
    };
    if (name == "nrows" || name == "datarows") shape_.count_texts.push_back(span());
    if (name == "indegrees")
      shape_.dialect +=
          in_lower_case(value) == "yes" ? ", angles in degrees" : ", angles in radians";
    if (name == "datarate" && table_number(value, '.', rate_) && rate_ > 0 && rate_ < 1e9)
      rate_text_ = span();
    if (name == "units" && is_length_unit(value)) unit_ = value;
    if (name != "datatype" || in_lower_case(value) == "double") return;
    has_vectors_ = value == "Vec3";
    const bool is_known = value == "Quaternion" || value == "Rotation" || value == "SpatialVec";
    if (!has_vectors_ && (must_be_ || is_known))
      fail(fmt::format("expected DataType=double or Vec3, found {}", excerpt(value)));
  }

  void behind_names() {
    shape_.rows = lines_.position();
    shape_.first_line = lines_.number() + 1;
  }

  void numbers() {
    TextLines row = lines_;
    const auto both_have = [&](char c) {
      return lines_.line().find(c) != std::string_view::npos &&
             row.line().find(c) != std::string_view::npos;
    };
    row.next();
    shape_.separator = between_words;
    for (const char candidate : {';', ',', '\t'})
      if (both_have(candidate)) shape_.separator = candidate;
    const std::vector<std::string> names = cells_of_line(lines_.line(), shape_.separator);
    behind_names();
    shape_.least_cells = named_columns(names);
    const Matrix rows = first_values(table_.text, shape_, names.size());
    shape_.roles = recognise_columns(names, rows);
    // One point among joint angles (`box_transX`) is no reason to leave the angles out.
    const auto places = std::ranges::count(shape_.roles.roles, ColumnRole::coordinate);
    if (2 * static_cast<std::size_t>(places) < names.size() - 1)
      shape_.roles = columns_in_layout(ColumnLayout::plain, names, rows);
  }

  // Markers, with a vector in each cell: `time m1` over `0 1,2,3`.
  void vectors() {
    TextLines row = lines_;
    const bool has_colons = row.next() && row.line().find(',') == std::string_view::npos &&
                            row.line().find(':') != std::string_view::npos;
    shape_.separator = has_colons ? between_colon_components : between_components;
    std::vector<std::string> markers = cells_of_line(lines_.line(), '\t');
    markers.resize(named_columns(markers));
    if (markers.size() < 2) fail("expected names of markers behind time, found none");
    std::vector<std::string> names = {markers[0]};
    for (std::size_t m = 1; m < markers.size(); ++m)
      for (const char axis : {'x', 'y', 'z'}) names.push_back(markers[m] + "." + axis);
    TablePoints points(names);
    points.set(0, ColumnRole::time);
    for (std::size_t c = 1; c < names.size(); ++c)
      points.coordinate(c, fmt::to_string((c - 1) / 3), markers[1 + (c - 1) / 3], (c - 1) % 3);
    shape_.least_cells = names.size();
    shape_.roles = points.roles();
    shape_.unit = unit_;
    shape_.rate_text = rate_text_;
    if (rate_text_) shape_.rate = rate_;
    behind_names();
  }

  const TableText& table_;
  TextLines lines_;
  bool must_be_ = false;
  TableShape shape_;
  bool has_vectors_ = false;
  double rate_ = 0;
  std::optional<TextSpan> rate_text_;
  std::string unit_;
};

}  // namespace

// OpenSim's storage (.sto) and motion (.mot) files: a head up to `endheader`, a line of names,
// rows. Spreadsheets make tables with commas of them.
std::optional<TableShape> storage_shape(const TableText& table) {
  return StorageHead(table).shape();
}

}  // namespace moclean
