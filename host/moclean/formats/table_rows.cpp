#include "moclean/formats/table_rows.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/column_names.hpp"
#include "moclean/formats/plain_number.hpp"
#include "moclean/formats/row_collector.hpp"
#include "moclean/formats/table_cells.hpp"
#include "moclean/formats/table_number.hpp"
#include "moclean/formats/table_times.hpp"
#include "moclean/formats/text_lines.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

constexpr double no_sample = std::numeric_limits<double>::quiet_NaN();

// What becomes of the cells of a column.
struct CellUse {
  enum class Kind : char { skipped, sample, time, frame, confidence } kind = Kind::skipped;
  std::size_t place = 0;  // of the sample in a frame, of the confidence among those
};

std::vector<CellUse> cell_uses(const TableShape& shape) {
  using Kind = CellUse::Kind;
  const ColumnRoles& roles = shape.roles;
  std::vector<CellUse> uses(roles.roles.size());
  std::size_t place = 0;
  for (const std::size_t c : roles.sample_columns()) uses[c] = {Kind::sample, place++};
  place = 0;
  for (const ColumnPoint& point : roles.points)
    if (point.confidence) uses[*point.confidence] = {Kind::confidence, place++};
  for (std::size_t c = 0; c < uses.size(); ++c) {
    if (roles.roles[c] == ColumnRole::time) uses[c].kind = Kind::time;
    const bool is_frame = roles.roles[c] == ColumnRole::index &&
                          named_quantity(roles.names[c]) == NamedQuantity::frame;
    if (is_frame) uses[c].kind = Kind::frame;
  }
  return uses;
}

class RowReader {
 public:
  RowReader(std::string_view text, const TableShape& shape, const std::filesystem::path& file,
            bool checks_times)
      : lines_(text.substr(0, shape.rows_end), shape.rows, shape.first_line),
        shape_(shape),
        file_(file),
        checks_times_(checks_times),
        is_quick_(shape.decimal == '.' && separator_in_text(shape.separator) == shape.separator &&
                  shape.separator != between_words),
        uses_(cell_uses(shape)),
        frames_(static_cast<Index>(shape.roles.sample_columns().size())) {
    for (const ColumnPoint& point : shape.roles.points)
      confidences_ += point.confidence.has_value();
  }

  TableRows read() {
    while (!rows_.stopped && lines_.next()) {
      if (is_no_row(lines_.line(), shape_.separator)) continue;
      samples_ = frames_.add(lines_.bytes_left());
      rows_.confidences.resize(rows_.confidences.size() + confidences_);
      row();
    }
    if (frames_.count() == 0) fail("expected a line of samples, found the end of the file");
    if (!rows_.stopped && 100 * rows_.repeated_times > static_cast<std::size_t>(frames_.count()))
      throw FileError(file_, first_repetition_.line, first_repetition_.text);
    rows_.samples = frames_.take();
    return std::move(rows_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw FileError(file_, lines_.number() + (frames_.count() == 0 ? 1 : 0), problem);
  }

  void row() {
    const std::string_view line = lines_.line();
    const char* position = line.data();
    const char* const end = position + line.size();
    std::size_t column = 0;
    // The quick way goes as far as it can, one cell is looked at closely, and so on. An empty cell
    // behind the last separator counts: `position` is behind `end` only once that was taken.
    while (is_quick_ && column < uses_.size() && position <= end) {
      column = quick_cells(column, position, end);
      if (column == uses_.size() || position > end) break;
      TableCells cells({position, end}, shape_.separator);
      do {
        cells.next();
        if (!use(column++, cells)) return;
        position = cells.after() + 1;
      } while (position < end && *position == '"' && column < uses_.size());
    }
    if (is_quick_ && column == uses_.size() && position <= end) surplus(position, end);
    if (!is_quick_) {
      for (TableCells cells(line, shape_.separator); cells.next(); ++column) {
        if (column >= uses_.size()) {
          if (!cells.text().empty()) fail_count();
        } else if (!use(column, cells)) {
          return;
        }
      }
    }
    if (column < shape_.least_cells) fail_count();
    for (; column < uses_.size(); ++column)
      if (uses_[column].kind == CellUse::Kind::sample) samples_[uses_[column].place] = no_sample;
  }

  // Numbers and empty cells, up to the first that is something else. Moves `position` to that
  // cell; behind `end` if there is none.
  std::size_t quick_cells(std::size_t column, const char*& position, const char* const end) {
    for (; column < uses_.size() && position <= end; ++column) {
      const CellUse use = uses_[column];
      if (use.kind == CellUse::Kind::time && rows_.are_clock_times) return column;
      const char* first = position;
      while (first != end && *first == ' ') ++first;
      double value = no_sample;
      const bool is_skipped = use.kind == CellUse::Kind::skipped;
      const char* const after = is_skipped ? skipped(position, end) : number_at(first, end, value);
      if (!after || (after != end && *after != shape_.separator)) return column;
      if (use.kind == CellUse::Kind::sample)
        sample(column, value, {first, static_cast<std::size_t>(after - first)});
      else if (!is_skipped)
        accept(column, value);
      position = after + 1;
    }
    return column;
  }

  // Cells behind the last column are empty.
  void surplus(const char* position, const char* end) const {
    for (TableCells cells({position, end}, shape_.separator); cells.next();)
      if (!cells.text().empty()) fail_count();
  }

  // The end of a cell that is not used; null if it has to be looked at.
  const char* skipped(const char* position, const char* end) const {
    for (; position != end && *position != shape_.separator; ++position)
      if (*position == '"') return nullptr;
    return position;
  }

  // The end of a number or of nothing; null if there is something else. std::from_chars comes first
  // where the quick way failed lately: in a file of 17 digits it fails every time.
  const char* number_at(const char* first, const char* end, double& value) {
    constexpr int retry = 256;
    if (first == end || *first == shape_.separator) return first;
    if (others_ == 0) {
      const char* const after = plain_number(first, end, value);
      if (after && (after == end || *after == shape_.separator)) return after;
      if (*first <= '9') others_ = retry;
    } else {
      --others_;
    }
    const auto [after, error] = std::from_chars(first, end, value);
    return error == std::errc() ? after : nullptr;
  }

  // False if the cell cannot be read.
  bool use(std::size_t column, const TableCells& cells) {
    const CellUse use = uses_[column];
    if (use.kind == CellUse::Kind::skipped) return true;
    double value = no_sample;
    const std::string_view text = cells.text();
    const bool is_time = use.kind == CellUse::Kind::time;
    if (is_time && rows_.are_clock_times ? !clock(text, value)
                                         : !table_number(text, shape_.decimal, value)) {
      if (is_time && rows_.times.empty() && !rows_.are_clock_times && clock(text, value)) {
        rows_.are_clock_times = true;
      } else if (!says_missing(text)) {
        rows_.stopped = {lines_.number(), column, std::string(text)};
        return false;
      } else {
        value = no_sample;
      }
    }
    if (use.kind == CellUse::Kind::sample)
      sample(column, value, cells.raw());
    else
      accept(column, value);
    return true;
  }

  void sample(std::size_t column, double value, std::string_view text) {
    const bool is_missing = !(std::abs(value) <= std::numeric_limits<double>::max());
    if (is_missing && !std::isnan(value))
      fail(fmt::format("expected a finite number, found {} in {}", excerpt(text), at(column)));
    samples_[uses_[column].place] = is_missing ? no_sample : value;  // NaN of either sign
    if (!is_missing || has_missing_) return;
    rows_.missing_text = text;
    has_missing_ = true;
  }

  // A time that a clock shows, as seconds since the first one. Behind midnight they go on.
  bool clock(std::string_view text, double& value) {
    constexpr std::int64_t day = 86400;
    const std::optional<ClockTime> time = clock_time(text);
    if (!time) return false;
    clock_ = text;
    if (rows_.times.empty()) first_second_ = time->seconds;
    std::int64_t seconds = time->seconds - first_second_ + days_ * day;
    const bool is_next_day = !time->has_date && !rows_.times.empty() &&
                             static_cast<double>(seconds) < rows_.times.back() - day / 2;
    if (is_next_day) {
      ++days_;
      seconds += day;
    }
    value = static_cast<double>(seconds) + time->fraction;
    return true;
  }

  void accept(std::size_t column, double value) {
    if (uses_[column].kind == CellUse::Kind::confidence)
      rows_.confidences[rows_.confidences.size() - confidences_ + uses_[column].place] = value;
    else if (uses_[column].kind == CellUse::Kind::time)
      time(column, value);
    else
      frame_number(column, value);
  }

  void time(std::size_t column, double value) {
    if (checks_times_) {
      if (!std::isfinite(value)) fail(fmt::format("expected a time in {}, found none", at(column)));
      if (!rows_.times.empty() && !(value > rows_.times.back())) standing_time(column, value);
    }
    rows_.times.push_back(value);
    last_clock_ = clock_;
  }

  // Programs that integrate write the last frame twice, and loggers one now and then; times of too
  // few digits stand still again and again.
  void standing_time(std::size_t column, double value) {
    const bool is_same = value == rows_.times.back();
    const auto problem = [&] {
      return fmt::format(
          "expected a time after {}, found {} in {}{}", shown(rows_.times.back(), last_clock_),
          shown(value, clock_), at(column),
          is_same ? ": are the times printed with too few digits? --rate states the rate" : "");
    };
    if (!is_same) fail(problem());
    if (rows_.repeated_times++ == 0)
      first_repetition_ = {.line = lines_.number(), .column = column, .text = problem()};
  }

  void frame_number(std::size_t column, double value) {
    if (checks_times_ && value <= last_frame_)
      fail(
          fmt::format("expected a frame after {}, found {} in {}: a table with several rows of one "
                      "frame, or of several takes, is not read",
                      last_frame_, value, at(column)));
    if (!std::isnan(value)) last_frame_ = value;
  }

  std::string shown(double time, std::string_view clock) const {
    return rows_.are_clock_times ? std::string(clock) : fmt::to_string(time);
  }

  std::string at(std::size_t column) const {
    return fmt::format("column {} ({})", column + 1, excerpt(shape_.roles.names[column]));
  }

  [[noreturn]] void fail_count() const {
    std::size_t count = 0;
    bool are_whole = shape_.separator == ',';
    for (TableCells cells(lines_.line(), shape_.separator); cells.next(); ++count)
      are_whole = are_whole && cells.text().find_first_not_of("0123456789+-") == std::string::npos;
    fail(fmt::format("expected {} columns, found {}{}", uses_.size(), count,
                     are_whole && 2 * count > 3 * uses_.size()
                         ? ": if the comma is both separator and decimal mark, separate by ; or tab"
                         : ""));
  }

  TextLines lines_;
  const TableShape& shape_;
  const std::filesystem::path& file_;
  bool checks_times_;
  bool is_quick_;
  std::vector<CellUse> uses_;
  RowCollector frames_;
  std::size_t confidences_ = 0;
  TableRows rows_;
  double* samples_ = nullptr;
  double last_frame_ = -std::numeric_limits<double>::infinity();
  std::int64_t first_second_ = 0, days_ = 0;  // of clock times
  std::string_view clock_, last_clock_;
  UnreadableCell first_repetition_;
  bool has_missing_ = false;
  int others_ = 0;
};

}  // namespace

bool is_no_row(std::string_view line, char separator) {
  const std::size_t first = line.find_first_not_of(separator == '\t' ? " " : " \t");
  return first == std::string_view::npos || line[first] == '#';
}

TableRows read_rows(std::string_view text, const TableShape& shape,
                    const std::filesystem::path& file, bool checks_times) {
  return RowReader(text, shape, file, checks_times).read();
}

TableSurvey survey_rows(std::string_view text, const TableShape& shape, std::size_t most_rows) {
  TableSurvey survey;
  survey.numbers.resize(shape.roles.roles.size());
  TextLines lines(text.substr(0, shape.rows_end), shape.rows);
  while (most_rows > 0 && lines.next()) {
    if (is_no_row(lines.line(), shape.separator)) continue;
    --most_rows;
    std::size_t column = 0;
    for (TableCells cells(lines.line(), shape.separator);
         cells.next() && column < survey.numbers.size(); ++column) {
      double value = 0;
      const bool is_number =
          table_number(cells.text(), '.', value) || table_number(cells.text(), ',', value);
      const ColumnRole role = shape.roles.roles[column];
      const bool is_clock = role == ColumnRole::time && !is_number && clock_time(cells.text());
      if (is_clock || (is_number && !std::isnan(value))) ++survey.numbers[column];
      if (!is_number || role == ColumnRole::other || role == ColumnRole::angle) continue;
      survey.with_point += has_decimal(cells.text(), '.');
      survey.with_comma += has_decimal(cells.text(), ',');
    }
  }
  return survey;
}

}  // namespace moclean
