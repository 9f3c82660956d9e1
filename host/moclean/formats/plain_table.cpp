#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/column_names.hpp"
#include "moclean/formats/table_cells.hpp"
#include "moclean/formats/table_number.hpp"
#include "moclean/formats/table_rows.hpp"
#include "moclean/formats/table_shape.hpp"
#include "moclean/formats/table_times.hpp"
#include "moclean/formats/text_lines.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

// Name and value of a comment `# name: value`.
std::pair<std::string_view, std::string_view> setting(std::string_view comment) {
  const auto trim = [](std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t#");
    if (first == std::string_view::npos) return std::string_view();
    return text.substr(first, text.find_last_not_of(" \t,;") - first + 1);
  };
  const std::size_t colon = comment.find(':');
  if (colon == std::string_view::npos) return {};
  return {trim(comment.substr(0, colon)), trim(comment.substr(colon + 1))};
}

std::optional<UpAxis> up_axis(std::string_view letter) {
  if (letter.size() != 1 || letter < "x" || letter > "z") return std::nullopt;
  return static_cast<UpAxis>(letter[0] - 'x');
}

std::size_t count_cells(std::string_view line, char separator) {
  std::size_t count = 0;
  for (TableCells cells(line, separator); cells.next();) ++count;
  return count;
}

bool is_number_cell(std::string_view text) {
  double value = 0;
  return table_number(text, '.', value) || table_number(text, ',', value);
}

bool are_numbers(std::string_view line, char separator) {
  std::size_t count = 0;
  for (TableCells cells(line, separator); cells.next();) {
    const bool is_number = is_number_cell(cells.text());
    if (!is_number && !says_missing(cells.text())) return false;
    count += is_number;
  }
  return count > 0;
}

constexpr std::string_view separators = ",;\t|";

// How well a separator fits to a line of names and rows: 3 if all have as many cells, and no cell
// that is not in quotes holds another separator unless it is a number or a time; 2 if the first row
// has as many; 1 if it stands among the names; 0 if it does not, or tears a name in quotes.
int fit(char separator, std::string_view names, const std::vector<std::string_view>& rows) {
  std::size_t count = 0;
  for (TableCells cells(names, separator); cells.next(); ++count)
    if (!cells.is_quoted() && cells.text().find('"') != std::string_view::npos) return 0;
  if (count < 2) return 0;
  if (rows.empty() || count_cells(rows[0], separator) != count) return 1;
  for (const std::string_view row : rows) {
    std::size_t found = 0;
    for (TableCells cells(row, separator); cells.next(); ++found) {
      const bool is_whole = cells.is_quoted() ||
                            cells.text().find_first_of(separators) == std::string_view::npos ||
                            is_number_cell(cells.text()) || clock_time(cells.text());
      if (!is_whole) return 2;
    }
    if (found != count) return 2;
  }
  return 3;
}

// The one that fits best; of those that fit equally well the first.
char separator_between(std::string_view names, const std::vector<std::string_view>& rows) {
  char best = 0;
  int most = 0;
  for (const char candidate : separators)
    if (const int own = fit(candidate, names, rows); own > most) {
      best = candidate;
      most = own;
    }
  if (best) return best;
  // A name alone may stand over `t x y`.
  const bool are_names = rows.size() > 1 && !is_number_cell(rows[0].substr(0, rows[0].find('\t')));
  if (are_names && count_cells(rows[0], '\t') > 1) return '\t';
  const std::string_view row = rows.empty() ? std::string_view() : rows[0];
  const std::size_t words = count_cells(names, between_words);
  const std::size_t cells = count_cells(row, between_words);
  const bool are_words =
      words > 1 &&
      (rows.empty() ? are_numbers(names, between_words)  // one row, names in a comment
                    : (words == cells || words + 1 == cells) && are_numbers(row, between_words));
  return are_words ? between_words : ',';
}

class PlainHead {
 public:
  explicit PlainHead(const TableText& table) : table_(table), lines_(table.text) {}

  TableShape shape() {
    separator_line();
    comments();
    names();
    axis_line();
    row_names();
    unit_line();
    shape_.least_cells = named_columns(names_);
    shape_.roles.names = names_;
    shape_.roles = recognise_columns(names_, first_values(table_.text, shape_, names_.size()));
    if (has_row_names_ && shape_.roles.roles[0] != ColumnRole::index)
      shape_.roles.roles[0] = ColumnRole::other;  // they need not count
    units();
    const TableSurvey survey = survey_rows(table_.text, shape_, 32);
    if (survey.with_comma > 0 && survey.with_point == 0) shape_.decimal = ',';
    return std::move(shape_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw FileError(table_.file, std::max<std::size_t>(1, lines_.number()), problem);
  }

  bool has_options() const {
    return !table_.options.columns.empty() || table_.options.layout != ColumnLayout::automatic;
  }

  // Moves on; false at the end of the text.
  bool next_line() {
    do
      if (!lines_.next()) return false;
    while (lines_.line().find_first_not_of(" \t") == std::string_view::npos);
    return true;
  }

  // `sep=;`, by which Excel is told of the separator.
  void separator_line() {
    has_line_ = next_line();
    if (!has_line_) return;
    std::string_view line = lines_.line();
    if (line.starts_with('"') && line.ends_with('"') && line.size() > 1)
      line = line.substr(1, line.size() - 2);
    if (line.size() != 5 || in_lower_case(line.substr(0, 4)) != "sep=") return;
    stated_separator_ = line[4];
    has_line_ = next_line();
  }

  void comments() {
    while (has_line_) {
      const std::string_view line = lines_.line();
      const std::size_t mark = line.find_first_not_of(" \t");
      if (line[mark] != '#') return;
      comment_ = line.substr(mark + 1);
      const auto [name, value] = setting(line);
      if (name == "unit") shape_.unit = value;
      if (name == "up") shape_.up = up_axis(value);
      if (name == "frame_rate") rate(value);
      has_line_ = next_line();
    }
  }

  void rate(std::string_view value) {
    const char* const last = value.data() + value.size();
    const auto [after, error] = std::from_chars(value.data(), last, shape_.rate);
    if (error != std::errc() || after != last || !std::isfinite(shape_.rate) || shape_.rate < 0)
      fail("expected a frame rate in Hz, found " + excerpt(value));
    shape_.rate_text =
        TextSpan{static_cast<std::size_t>(value.data() - table_.text.data()), value.size()};
  }

  // Some lines behind this one, which has the names.
  std::vector<std::string_view> rows_after() const {
    constexpr std::size_t most = 8, byte_limit = 1 << 16;
    std::vector<std::string_view> rows;
    std::size_t bytes = 0;
    for (TextLines after = lines_; rows.size() < most && bytes < byte_limit && after.next();) {
      if (is_no_row(after.line(), 0)) continue;
      rows.push_back(after.line());
      bytes += after.line().size();
    }
    return rows;
  }

  void names() {
    if (!has_line_) fail("expected a line of column names, found the end of the file");
    const std::string_view line = lines_.line();
    shape_.separator =
        stated_separator_ ? stated_separator_ : separator_between(line, rows_after());
    if (are_numbers(line, shape_.separator)) {
      names_elsewhere(line);
      return;
    }
    names_ = cells_of_line(line, shape_.separator);
    // A name that our own writer kept from being executed by a spreadsheet, or taken for a number.
    for (std::string& name : names_)
      if (name.size() > 1 && name[0] == '\'' &&
          (std::string_view("=+-@").find(name[1]) != name.npos || is_number_cell(name.substr(1))))
        name.erase(0, 1);
    rows_behind();
  }

  // The first line has numbers: np.savetxt(header=...) writes the names as a comment.
  void names_elsewhere(std::string_view line) {
    const std::size_t count = count_cells(line, shape_.separator);
    const std::vector<std::string> commented = cells_of_line(comment_, shape_.separator);
    if (!comment_.empty() && commented.size() == count) {
      names_ = commented;
    } else if (has_options()) {
      for (std::size_t c = 0; c < count; ++c) names_.push_back(fmt::format("column{}", c));
    } else {
      fail(
          "expected a line of column names, found numbers; --columns or --layout say what they "
          "are");
    }
    shape_.rows = lines_.begin();
    shape_.first_line = lines_.number();
  }

  void rows_behind() {
    shape_.rows = lines_.position();
    shape_.first_line = lines_.number() + 1;
  }

  // The first line behind the names that is a row or a part of the head; false if there is none.
  bool next_part(TextLines& after) const {
    after = TextLines(table_.text, shape_.rows, shape_.first_line);
    do
      if (!after.next()) return false;
    while (is_no_row(after.line(), shape_.separator));
    return true;
  }

  // A line of X, Y, Z under names of points, each of which stands over its first column or over
  // all.
  void axis_line() {
    TextLines after = lines_;
    if (!next_part(after)) return;
    const std::vector<std::string> axes = cells_of_line(after.line(), shape_.separator);
    if (!are_axes(axes)) return;
    names_.resize(std::max(names_.size(), axes.size()));
    std::string point;
    for (std::size_t c = 0; c < axes.size(); ++c) {
      if (!names_[c].empty()) point = names_[c];
      if (axes[c].empty()) continue;
      const NamedQuantity quantity = named_quantity(axes[c]);
      const bool is_of_frame = quantity == NamedQuantity::time || quantity == NamedQuantity::frame;
      names_[c] = point.empty() || is_of_frame ? axes[c] : point + " " + axes[c];
    }
    lines_ = after;
    rows_behind();
  }

  // Whether cells are x, y, z and what else stands beside these.
  static bool are_axes(const std::vector<std::string>& cells) {
    std::size_t count = 0;
    for (const std::string& cell : cells) {
      const NamedQuantity quantity = named_quantity(cell);
      const bool is_axis =
          cell.size() == 1 && std::string_view("xyzXYZ").find(cell[0]) != std::string_view::npos;
      const bool is_other = quantity == NamedQuantity::time || quantity == NamedQuantity::frame ||
                            quantity == NamedQuantity::confidence || cell.empty() ||
                            in_lower_case(cell) == "sub frame";
      if (!is_axis && !is_other) return false;
      count += is_axis;
    }
    return count > 1;
  }

  // R writes names of rows, but none above them.
  void row_names() {
    TextLines after = lines_;
    if (!next_part(after)) return;
    const std::vector<std::string> row = cells_of_line(after.line(), shape_.separator);
    has_row_names_ = row.size() == names_.size() + 1 && !row.back().empty() && row.front() == "1";
    if (has_row_names_) names_.insert(names_.begin(), "");
  }

  // A line of units under the names.
  void unit_line() {
    TextLines after = lines_;
    if (!next_part(after)) return;
    bool has_unit = false;
    for (const std::string& cell : cells_of_line(after.line(), shape_.separator)) {
      const std::string unit = unit_in(cell);
      if (!cell.empty() && unit.empty()) return;
      has_unit = has_unit || (!unit.empty() && unit != "-");
      units_.push_back(unit);
    }
    if (!has_unit) {
      units_.clear();
      return;
    }
    lines_ = after;
    rows_behind();
  }

  static std::string unit_in(const std::string& cell) {
    const std::string in_brackets = unit_of_name("x " + cell);
    if (!in_brackets.empty()) return in_brackets;
    return is_unit(cell) && !is_number_cell(cell) ? cell : std::string();
  }

  // The unit is that of all coordinates, if they have one.
  void units() {
    if (!shape_.unit.empty()) return;
    std::optional<std::string> common;
    for (const ColumnPoint& point : shape_.roles.points)
      for (const std::size_t c : point.columns) {
        const std::string own = c < units_.size() ? units_[c] : unit_of_name(names_[c]);
        if (!is_length_unit(own) || (common && *common != own)) return;
        common = own;
      }
    if (common) shape_.unit = *common;
  }

  const TableText& table_;
  TextLines lines_;
  TableShape shape_;
  bool has_line_ = false, has_row_names_ = false;
  char stated_separator_ = 0;
  std::string_view comment_;  // the last one before the names
  std::vector<std::string> names_, units_;
};

}  // namespace

std::vector<std::string> cells_of_line(std::string_view line, char separator) {
  std::vector<std::string> names;
  for (TableCells cells(line, separator); cells.next();) names.push_back(unquoted(cells));
  return names;
}

std::size_t named_columns(const std::vector<std::string>& names) {
  std::size_t count = names.size();
  while (count > 0 && names[count - 1].empty()) --count;
  return count;
}

Matrix first_values(std::string_view text, const TableShape& shape, std::size_t columns) {
  constexpr Index most_rows = 32, most_values = 1 << 20;
  const auto width = static_cast<Index>(columns);
  const Index most = std::clamp<Index>(most_values / std::max<Index>(width, 1), 2, most_rows);
  Matrix values = Matrix::Constant(most, width, std::numeric_limits<double>::quiet_NaN());
  Index row = 0;
  for (TextLines lines(text.substr(0, shape.rows_end), shape.rows); row < most && lines.next();) {
    if (is_no_row(lines.line(), shape.separator)) continue;
    Index column = 0;
    for (TableCells cells(lines.line(), shape.separator); cells.next() && column < values.cols();
         ++column) {
      double value = 0;
      if (table_number(cells.text(), '.', value) || table_number(cells.text(), ',', value))
        values(row, column) = value;
    }
    ++row;
  }
  return values.topRows(row);
}

TableShape plain_shape(const TableText& table) { return PlainHead(table).shape(); }

}  // namespace moclean
