#include "moclean/formats/trc.hpp"

#include <algorithm>
#include <any>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/row_collector.hpp"
#include "moclean/formats/text_scanner.hpp"
#include "moclean/formats/trc_text.hpp"

namespace moclean {
namespace {

constexpr std::string_view coordinates = "XYZ";

bool is_same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return (x | 0x20) == (y | 0x20); });
}

// What a Time column is worth: its seconds, and how far they may be off for being printed with few
// decimals.
struct Times {
  std::vector<double> seconds;
  double rounding = 1;

  void add(std::string_view cell, double value) {
    if (std::isnan(value)) return;
    seconds.push_back(value);
    const std::size_t point = cell.find('.');
    const std::size_t decimals = point == cell.npos ? 0 : cell.size() - point - 1;
    rounding = std::min(rounding, std::pow(10., -static_cast<double>(decimals)));
  }

  double mean_step() const {
    if (seconds.size() < 2) return 0;
    return (seconds.back() - seconds.front()) / static_cast<double>(seconds.size() - 1);
  }

  // Whether the mean step or, where frames were left out, the median one is that of the rate. One
  // that does not grow tells nothing.
  bool agree_with(double rate) const {
    const double mean = mean_step();
    if (!(mean > 0)) return true;
    std::vector<double> steps;
    for (std::size_t i = 1; i < seconds.size(); ++i) steps.push_back(seconds[i] - seconds[i - 1]);
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    const double slack = 0.02 / rate;
    return std::abs(mean - 1 / rate) <= slack + rounding / static_cast<double>(steps.size()) ||
           std::abs(*middle - 1 / rate) <= slack + rounding;
  }
};

class TrcParser {
 public:
  TrcParser(std::string_view text, const std::filesystem::path& file, const ReadOptions& options)
      : text_(text),
        file_(file),
        options_(options),
        lines_(text, text.starts_with("\xEF\xBB\xBF") ? 3 : 0) {}

  Recording parse() {
    path_line();
    settings();
    markers();
    coordinate_labels();
    rows();
    rate();
    recording_.source = document();
    return std::move(recording_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw FileError(file_, std::max<std::size_t>(1, lines_.number()), problem);
  }

  // The next line that is not blank.
  void expect_line(std::string_view what) {
    do
      if (!lines_.next()) fail(fmt::format("expected {}, found the end of the file", what));
    while (is_trc_blank(lines_.line()));
  }

  void path_line() {
    expect_line("PathFileType");
    const std::vector<std::string_view> cells = trc_cells(lines_.line());
    // Also with blanks before the 4, as in files of OpenSim's own examples.
    const std::string_view word = cells[0].substr(0, cells[0].find(' '));
    if (!is_same_word(word, "PathFileType"))
      fail(fmt::format("expected PathFileType, found {}", excerpt(cells[0])));
    for (std::string_view cell : cells) {
      cell = cell.substr(0, cell.find(' '));  // the path may follow in the same cell
      if (cell.starts_with('(') && cell.find('/') != cell.npos && !is_same_word(cell, "(X/Y/Z)"))
        fail(fmt::format("expected coordinates (X/Y/Z), found {}", excerpt(cell)));
    }
  }

  void settings() {
    expect_line("a line with DataRate, NumFrames, NumMarkers, Units");
    const std::vector<std::string_view> names = trc_cells(lines_.line());
    expect_line("the values of DataRate, NumFrames, NumMarkers, Units");
    const std::vector<std::string_view> values = trc_settings(lines_.line(), names.size());
    bool has_rate = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string_view value = i < values.size() ? values[i] : std::string_view();
      if (is_same_word(names[i], "DataRate")) {
        recording_.frame_rate = setting(names[i], value);
        has_rate = true;
      }
      if (is_same_word(names[i], "NumMarkers")) stated_markers_ = setting(names[i], value);
      if (is_same_word(names[i], "Units")) recording_.unit = value;
    }
    if (!has_rate) fail("expected DataRate in the line above, found none");
    if (recording_.unit == "unknown") recording_.unit.clear();
    rate_line_ = lines_.number();
  }

  double setting(std::string_view name, std::string_view text) const {
    double value = 0;
    if (!trc_sample(text, value) || !(value >= 0))
      fail(fmt::format("expected a number for {}, found {}", name, excerpt(text)));
    return value;
  }

  void markers() {
    expect_line("Frame#, Time and the markers");
    markers_line_ = lines_.number();
    const std::vector<std::string_view> cells = trc_cells(lines_.line());
    if (cells.size() < 3 || !cells[0].starts_with("Frame") || !is_same_word(cells[1], "Time"))
      fail(fmt::format("expected Frame#, Time and the markers, found {}", excerpt(lines_.line())));
    for (std::size_t c = 2; c < cells.size(); ++c) {
      if (cells[c].empty()) continue;
      for (const std::string_view axis : {".x", ".y", ".z"})
        recording_.columns.push_back(std::string(cells[c]).append(axis));
    }
    const std::size_t found = recording_.columns.size() / 3;
    has_virtual_ = stated_markers_ && *stated_markers_ < static_cast<double>(found);
    has_unnamed_ = stated_markers_ && *stated_markers_ > static_cast<double>(found);
  }

  void coordinate_labels() {
    expect_line("X1, Y1, Z1 ...");
    std::size_t count = 0;
    for (const std::string_view cell : trc_cells(lines_.line())) {
      if (cell.empty()) continue;
      if ((cell[0] & ~0x20) != coordinates[count++ % coordinates.size()])
        fail(fmt::format("expected X1, Y1, Z1 ..., found {}", excerpt(cell)));
    }
    const std::size_t named = recording_.columns.size();
    if (has_virtual_) {
      virtual_markers(count);
      return;
    }
    if (count < named || (count > named && !has_unnamed_))
      fail(fmt::format("expected X, Y, Z of the {} markers above, found {} cells", named / 3,
                       count));
  }

  // Cortex does not count markers in NumMarkers, and in some versions not in the labels, that it
  // has calculated from others. Rows may have them or not.
  void virtual_markers(std::size_t labels) {
    const std::size_t named = recording_.columns.size();
    if (labels != named && static_cast<double>(labels) != 3 * *stated_markers_)
      throw FileError(
          file_, markers_line_,
          fmt::format("expected {} markers (NumMarkers), found {}", *stated_markers_, named / 3));
    TextLines row = lines_;
    while (row.next() && is_trc_blank(row.line())) {
    }
    if (labels != named && trc_cells(row.line()).size() <= labels + 2)
      recording_.columns.resize(labels);
  }

  void rows() {
    expect_line("a row of samples");
    rows_begin_ = lines_.begin();
    rows_line_ = lines_.number();
    RowCollector frames(static_cast<Index>(recording_.columns.size()));
    do
      if (!is_trc_blank(lines_.line())) row(frames.add(lines_.bytes_left()));
    while (lines_.next());
    recording_.samples = frames.take();
  }

  void row(double* samples) {
    TrcCells cells(lines_.line());
    double number = 0, time = 0;
    if (!cells.next() || cells.cell().empty() || !trc_sample(cells.cell(), number))
      fail(fmt::format("expected a frame number, found {}", excerpt(cells.cell())));
    if (!cells.next() || !trc_sample(cells.cell(), time))
      fail(fmt::format("expected a time, found {}", excerpt(cells.cell())));
    times_.add(cells.cell(), time);
    const std::size_t columns = recording_.columns.size();
    for (std::size_t c = 0; c < columns; ++c) {
      if (!cells.next()) {
        leave_missing(samples, c, cells.has_tabs());
        return;
      }
      if (!trc_sample(cells.cell(), samples[c])) fail_number(cells.cell());
    }
    while (!has_unnamed_ && cells.next())
      if (!cells.cell().empty())
        fail(fmt::format("expected {} cells, found more: {}", columns + 2, excerpt(cells.cell())));
  }

  // The row ends before column `first`: editors take tabs away at the end of lines.
  void leave_missing(double* samples, std::size_t first, bool has_tabs) const {
    const std::size_t columns = recording_.columns.size();
    if (!has_tabs && first > 0)
      fail(
          fmt::format("expected {} numbers, found {}; which are missing cannot be told without "
                      "tabs: write nan for them",
                      columns + 2, first + 2));
    if (first % 3 != 0 || !lines_.has_end())
      fail(fmt::format("expected {} cells, found {}", columns + 2, first + 2));
    std::fill(samples + first, samples + columns, std::numeric_limits<double>::quiet_NaN());
  }

  [[noreturn]] void fail_number(std::string_view cell) const {
    const bool has_comma = cell.find(',') != cell.npos;
    fail(fmt::format("expected a number, found {}{}", excerpt(cell),
                     has_comma ? "; decimals stand behind a point, not a comma" : ""));
  }

  void rate() {
    const double stated = recording_.frame_rate;
    if (stated == 0 || times_.agree_with(stated)) column_rate_ = stated;
    if (options_.rate > 0) recording_.frame_rate = options_.rate;
    if (options_.rate > 0 || column_rate_) return;
    throw FileError(file_, rate_line_,
                    fmt::format("expected a Time column of DataRate {:.6g} Hz, found one of {:.6g} "
                                "Hz; --rate states which is right",
                                stated, 1 / times_.mean_step()));
  }

  TrcDocument document() const {
    const Index first = options_.frames.first.value_or(0);
    const Index last = options_.frames.last.value_or(recording_.frames());
    return {.text = std::string(text_),
            .rows = rows_begin_,
            .first_line = rows_line_,
            .first_frame = first,
            .frames = last - first,
            .columns = recording_.columns,
            .frame_rate = column_rate_.value_or(-1),
            .unit = recording_.unit};
  }

  std::string_view text_;
  const std::filesystem::path& file_;
  const ReadOptions& options_;
  TextLines lines_;
  Recording recording_;
  std::optional<double> stated_markers_;
  bool has_unnamed_ = false, has_virtual_ = false;
  std::size_t markers_line_ = 0, rate_line_ = 0, rows_begin_ = 0, rows_line_ = 0;
  Times times_;
  std::optional<double> column_rate_;  // that DataRate and Time agree on
};

Recording read_trc(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions& options) {
  return parse_trc(content, file, options);
}

}  // namespace

Recording parse_trc(std::string_view text, const std::filesystem::path& file,
                    const ReadOptions& options) {
  return TrcParser(text, file, options).parse();
}

constinit const Format trc_format = {
    .name = "TRC",
    .extension = ".trc",
    .notes =
        "markers of OpenSim, Motion Analysis and Pose2Sim; empty or `nan` is a missing sample; "
        "Frame#, Time and unnamed trajectories are kept",
    .content = {.names = true, .frame_rate = true, .unit = true, .gaps = true},
    .read = read_trc,
    .write = write_trc,
};

}  // namespace moclean
