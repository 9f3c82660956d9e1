#include <algorithm>
#include <any>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "moclean/formats/table_cells.hpp"
#include "moclean/formats/table_document.hpp"
#include "moclean/formats/table_number.hpp"
#include "moclean/formats/table_rows.hpp"
#include "moclean/formats/text_lines.hpp"
#include "moclean/formats/written_text.hpp"
#include "moclean/motion/framed_source.hpp"

namespace moclean {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

bool is_same_number(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

class TableWriter {
 public:
  TableWriter(AtomicFile& file, const TableDocument& document, const Recording& recording)
      : file_(file),
        document_(document),
        shape_(document.shape),
        recording_(recording),
        first_(std::any_cast<FramedSource>(&recording.source)->first),
        columns_(shape_.roles.sample_columns()),
        joints_(joints(recording)),
        before_(recording.columns.size()),
        cells_(shape_.roles.roles.size()) {
    text_is_unicode_ = document.content.encoding != TextEncoding::utf8;
    for (const ColumnPoint& point : shape_.roles.points)
      if (point.confidence && document.uses_confidence)
        judged_.push_back({static_cast<std::size_t>(std::ranges::find(columns_, point.columns[0]) -
                                                    columns_.begin()),
                           point.columns.size(), *point.confidence});
    zero_is_missing_ = has_other_confidence();
  }

  void write() {
    if (document_.content.has_mark) file_.write(byte_order_mark(document_.content.encoding));
    head();
    rows();
    const std::string_view text = document_.content.text;
    if (shape_.rows_end < text.size()) text_ += text.substr(shape_.rows_end);
    flush();
  }

 private:
  struct Cell {
    std::string_view raw;
    bool is_quoted = false;
    double number = nothing;
  };

  // Where every confidence is 0, as may be in a part of the frames, nobody takes it for missing.
  bool has_other_confidence() const {
    const bool has_all = recording_.frames() == document_.frames;
    if (has_all || judged_.empty()) return has_all;
    const std::string_view text = document_.content.text;
    Index frame = -first_;
    for (TextLines lines(text.substr(0, shape_.rows_end), shape_.rows); lines.next();) {
      if (is_no_row(lines.line(), shape_.separator) || frame++ < 0) continue;
      if (frame > recording_.frames()) break;
      std::size_t column = 0;
      for (TableCells cells(lines.line(), shape_.separator); cells.next(); ++column) {
        double value = 0;
        if (std::ranges::find(judged_, column, &JudgedPoint::confidence) != judged_.end() &&
            table_number(cells.text(), shape_.decimal, value) && value != 0 && !std::isnan(value))
          return true;
      }
    }
    return false;
  }

  void flush() {
    file_.write(text_is_unicode_ ? encoded(text_, document_.content.encoding) : text_);
    text_.clear();
  }

  // All before the rows, with the rate and the number of frames that the recording has.
  void head() {
    std::vector<std::pair<TextSpan, std::string>> stated;
    const double rate = recording_.frame_rate;
    if (shape_.rate_text && rate > 0 && rate != shape_.rate)
      stated.emplace_back(*shape_.rate_text, fmt::to_string(rate));
    if (recording_.frames() != document_.frames)
      for (const TextSpan& span : shape_.count_texts)
        stated.emplace_back(span, fmt::to_string(recording_.frames()));
    std::ranges::sort(stated, {}, [](const auto& item) { return item.first.begin; });
    std::size_t copied = 0;
    const std::string_view text = document_.content.text;
    for (const auto& [span, replacement] : stated) {
      text_ += text.substr(copied, span.begin - copied);
      text_ += replacement;
      copied = span.begin + span.length;
    }
    text_ += text.substr(copied, shape_.rows - copied);
  }

  void rows() {
    const std::string_view text =
        std::string_view(document_.content.text).substr(0, shape_.rows_end);
    const bool has_all = first_ == 0 && recording_.frames() == document_.frames;
    Index frame = -first_;
    for (TextLines lines(text, shape_.rows); lines.next();) {
      const bool is_row = !is_no_row(lines.line(), shape_.separator);
      if (is_row && frame == recording_.frames()) break;
      const bool is_wanted = is_row ? frame >= 0 : has_all || frame > 0;
      if (is_row && is_wanted) row(lines.line(), frame);
      const std::size_t rest = lines.begin() + (is_row ? lines.line().size() : 0);
      if (is_wanted) text_ += text.substr(rest, lines.position() - rest);
      frame += is_row;
      if (text_.size() >= text_chunk) flush();
    }
  }

  void row(std::string_view line, Index frame) {
    std::ranges::fill(cells_, Cell{});
    std::size_t count = 0;
    for (TableCells cells(line, shape_.separator); cells.next() && count < cells_.size(); ++count) {
      cells_[count] = {cells.raw(), cells.is_quoted()};
      if (!table_number(cells.text(), shape_.decimal, cells_[count].number))
        cells_[count].number = nothing;
    }
    observed_before();
    // Cells in the order of the line: those of a sample may stand in any.
    changes_.clear();
    for (std::size_t s = 0; s < columns_.size(); ++s)
      if (columns_[s] < count &&
          !is_same_number(before_[s], recording_.samples(frame, static_cast<Index>(s))))
        changes_.emplace_back(columns_[s], s);
    seen_now(frame);
    std::ranges::sort(changes_);
    const char* copied = line.data();
    for (const auto& [column, sample] : changes_) {
      const std::string_view raw = cells_[column].raw;
      text_.append(copied, raw.data());
      const double value = sample == is_confidence
                               ? document_.least_confidence
                               : recording_.samples(frame, static_cast<Index>(sample));
      put(value, cells_[column].is_quoted);
      copied = raw.data() + raw.size();
    }
    text_.append(copied, line.data() + line.size());
  }

  // Points of confidence 0 that have coordinates now.
  void seen_now(Index frame) {
    for (const auto& [first, count, confidence] : judged_) {
      const auto samples = recording_.samples.row(frame).segment(static_cast<Index>(first),
                                                                 static_cast<Index>(count));
      if (cells_[confidence].number == 0 && !samples.array().isNaN().any())
        changes_.emplace_back(confidence, is_confidence);
    }
  }

  // The row's samples as they were read: without points that were not seen, without marks.
  void observed_before() {
    for (std::size_t s = 0; s < columns_.size(); ++s) before_[s] = cells_[columns_[s]].number;
    for (const auto& [first, count, confidence] : judged_)
      if (zero_is_missing_ && cells_[confidence].number == 0)
        std::fill_n(before_.begin() + static_cast<std::ptrdiff_t>(first), count, nothing);
    if (document_.missing.empty()) return;
    for (const Joint& joint : joints_) {
      const auto first = before_.begin() + joint.first_column;
      const auto says = [&](double mark) {
        const auto is_mark = [mark](double sample) { return sample == mark; };
        return mark == 0 ? std::all_of(first, first + joint.columns, is_mark)
                         : std::any_of(first, first + joint.columns, is_mark);
      };
      if (std::ranges::any_of(document_.missing, says)) std::fill_n(first, joint.columns, nothing);
    }
  }

  void put(double value, bool is_quoted) {
    std::string spelling = document_.missing_text;
    const bool is_missing = std::isnan(value);
    if (is_missing && !document_.missing.empty()) spelling = spelled(document_.missing[0]);
    const bool needs_text = shape_.separator == between_words ||
                            separator_in_text(shape_.separator) != shape_.separator;
    if (is_missing && spelling.empty() && needs_text) spelling = "nan";
    if (!is_missing) spelling = spelled(value);
    const bool needs_quotes = spelling.find(shape_.separator) != spelling.npos;
    const bool has_quotes = spelling.starts_with('"');
    if (!has_quotes && (needs_quotes || (is_quoted && !spelling.empty())))
      spelling = '"' + spelling + '"';
    text_ += spelling;
  }

  std::string spelled(double value) const {
    std::array<char, 32> number{};
    char* const end = std::to_chars(number.data(), number.data() + number.size(), value).ptr;
    std::string text(number.data(), end);
    if (shape_.decimal == ',') std::ranges::replace(text, '.', ',');
    return text;
  }

  static constexpr std::size_t is_confidence = static_cast<std::size_t>(-1);

  struct JudgedPoint {
    std::size_t first, count, confidence;
  };

  AtomicFile& file_;
  const TableDocument& document_;
  const TableShape& shape_;
  const Recording& recording_;
  Index first_;
  std::vector<std::size_t> columns_;  // of the file, per sample
  std::vector<Joint> joints_;
  std::vector<JudgedPoint> judged_;
  bool zero_is_missing_ = true;  // as a confidence
  std::vector<double> before_;
  std::vector<Cell> cells_;
  std::vector<std::pair<std::size_t, std::size_t>> changes_;  // column, sample or is_confidence
  bool text_is_unicode_ = false;
  std::string text_;
};

}  // namespace

void write_table(AtomicFile& file, const TableDocument& document, const Recording& recording) {
  TableWriter(file, document, recording).write();
}

}  // namespace moclean
