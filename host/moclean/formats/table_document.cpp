#include "moclean/formats/table_document.hpp"

#include <algorithm>
#include <any>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/column_names.hpp"
#include "moclean/formats/confidence.hpp"
#include "moclean/formats/table_rows.hpp"
#include "moclean/formats/table_times.hpp"
#include "moclean/formats/text_lines.hpp"
#include "moclean/formats/text_scanner.hpp"
#include "moclean/motion/framed_source.hpp"

namespace moclean {
namespace {

TableShape shape_of(const TableText& table) {
  for (auto* const recognise :
       {motive_shape, nexus_shape, qtm_shape, pose_shape, storage_shape, levels_shape})
    if (auto shape = recognise(table)) return *std::move(shape);
  return plain_shape(table);
}

class TableReader {
 public:
  TableReader(std::string_view content, const std::filesystem::path& file,
              const ReadOptions& options, std::string_view extension)
      : file_(file), options_(options), document_(std::make_shared<TableDocument>()) {
    document_->extension = extension;
    document_->missing = options.missing;
    bool has_half_character = false;
    document_->content = decoded(content, has_half_character);
    if (has_half_character)
      throw FileError(file, "expected two bytes per character (UTF-16), found an odd number");
  }

  Recording read() {
    TableShape& shape = document_->shape;
    shape = shape_of({text(), file_, document_->extension, options_});
    if (options_.columns.empty())
      refuse_long_table({text(), file_, document_->extension, options_}, shape);
    state_columns(shape);
    Recording recording;
    end_behind_last_row(shape, recording.notes.warnings);
    TableRows rows = rows_of(shape);
    recording.columns = shape.roles.sample_names();
    recording.unit = shape.unit;
    recording.up = shape.up;
    recording.samples = std::move(rows.samples);
    if (!rows.confidences.empty())
      document_->uses_confidence = take_confidence(confidence_of(rows, recording), recording);
    document_->least_confidence = least_confidence(recording);
    rate(rows, recording);
    notes(recording);
    document_->frames = recording.frames();
    document_->columns = recording.columns;
    document_->missing_text = std::move(rows.missing_text);
    const std::uint64_t bytes = text().size();
    recording.source =
        FramedSource{.file = TableSource{std::move(document_)}, .first = 0, .bytes = bytes};
    return recording;
  }

 private:
  std::string_view text() const { return document_->content.text; }

  // What the options say of columns.
  void state_columns(TableShape& shape) const {
    const std::vector<std::string> names = shape.roles.names;
    if (!options_.columns.empty())
      shape.roles = parse_column_roles(options_.columns, names);
    else if (options_.layout != ColumnLayout::automatic)
      shape.roles =
          columns_in_layout(options_.layout, names, first_values(text(), shape, names.size()));
  }

  // Spreadsheets write rows of separators alone behind a table: they are no frames.
  void end_behind_last_row(TableShape& shape, std::vector<std::string>& warnings) const {
    const std::string_view rows = text().substr(0, shape.rows_end);
    const std::string nothing = std::string(" \t\r\n") + shape.separator;
    const std::size_t last = rows.find_last_not_of(nothing);
    if (last == rows.npos || last < shape.rows) return;
    const std::size_t line_end = rows.find_first_of("\r\n", last);
    if (line_end == rows.npos) return;
    const bool is_pair = rows.substr(line_end, 2) == "\r\n";
    shape.rows_end = line_end + (is_pair ? 2 : 1);
    std::size_t count = 0;
    TextLines tail(rows, shape.rows_end);
    while (tail.next()) count += tail.line().find(shape.separator) != tail.line().npos;
    if (count > 0)
      warnings.push_back(fmt::format("{} line{} of separators alone at the end, no frames", count,
                                     count == 1 ? "" : "s"));
  }

  // A cell that cannot be read may show that numbers have decimal commas, or that its column has no
  // numbers at all: then once more.
  TableRows rows_of(TableShape& shape) const {
    for (int attempt = 0;; ++attempt) {
      need_samples(shape);
      TableRows rows = read_rows(text(), shape, file_, !(options_.rate > 0));
      if (!rows.stopped) return rows;
      if (attempt == 2 || !adapt(shape, *rows.stopped)) fail_number(shape, *rows.stopped);
    }
  }

  void need_samples(const TableShape& shape) const {
    if (shape.roles.sample_columns().empty())
      throw FileError(file_, shape.first_line, "expected columns beside the time");
  }

  bool adapt(TableShape& shape, const UnreadableCell& cell) const {
    const TableSurvey survey = survey_rows(text(), shape);
    const bool is_point = shape.decimal == '.';
    const bool has_other = cell.text.find(is_point ? ',' : '.') != std::string::npos;
    if (survey.with_comma > 0 && survey.with_point > 0 && has_other)
      throw FileError(file_, cell.line,
                      fmt::format("expected a decimal {}, as in other cells, found {}",
                                  is_point ? "point" : "comma", excerpt(cell.text)));
    bool is_changed = survey.with_comma > 0 && is_point;
    if (is_changed) shape.decimal = ',';
    if (std::ranges::all_of(survey.numbers, [](std::size_t count) { return count == 0; }))
      return false;
    for (std::size_t c = 0; c < survey.numbers.size(); ++c) {
      ColumnRole& role = shape.roles.roles[c];
      const bool may_be_text = role == ColumnRole::plain || role == ColumnRole::time ||
                               role == ColumnRole::index || role == ColumnRole::confidence;
      if (!may_be_text || survey.numbers[c] > 0 || !options_.columns.empty()) continue;
      role = ColumnRole::other;
      for (ColumnPoint& point : shape.roles.points)
        if (point.confidence == c) point.confidence.reset();
      is_changed = true;
    }
    return is_changed;
  }

  [[noreturn]] void fail_number(const TableShape& shape, const UnreadableCell& cell) const {
    throw FileError(file_, cell.line,
                    fmt::format("expected a number, found {} in column {} ({})", excerpt(cell.text),
                                cell.column + 1, excerpt(shape.roles.names[cell.column])));
  }

  // [frames x columns], NaN where points have none.
  Matrix confidence_of(const TableRows& rows, const Recording& recording) const {
    const auto columns = document_->shape.roles.sample_columns();
    Matrix confidence = Matrix::Constant(recording.frames(), recording.samples.cols(),
                                         std::numeric_limits<double>::quiet_NaN());
    std::vector<std::pair<Index, Index>> segments;  // of points that have a confidence
    for (const ColumnPoint& point : document_->shape.roles.points)
      if (point.confidence)
        segments.emplace_back(std::ranges::find(columns, point.columns[0]) - columns.begin(),
                              point.columns.size());
    std::size_t place = 0;
    for (Index f = 0; f < recording.frames(); ++f)
      for (const auto& [first, count] : segments)
        confidence.row(f).segment(first, count).setConstant(rows.confidences[place++]);
    return confidence;
  }

  void rate(const TableRows& rows, Recording& recording) {
    const TableShape& shape = document_->shape;
    const auto time = std::ranges::find(shape.roles.roles, ColumnRole::time);
    if (time != shape.roles.roles.end()) {
      time_column_ = static_cast<std::size_t>(time - shape.roles.roles.begin());
      // Clock times are in seconds whatever the column is called.
      const std::string& name = shape.roles.names[*time_column_];
      scale_ = time_scale(rows.times, rows.are_clock_times ? "time (s)" : name);
    }
    if (rows.repeated_times > 0)
      recording.notes.warnings.push_back(fmt::format("{} frame{} the time of the one before",
                                                     rows.repeated_times,
                                                     rows.repeated_times == 1 ? " has" : "s have"));
    recording.frame_rate = shape.rate > 0 ? shape.rate : scale_.rate;
    const double found = recording.frame_rate;
    auto& warnings = recording.notes.warnings;
    if (scale_.unit == "frames" && found == 0)
      warnings.push_back(fmt::format("{} counts frames and tells no rate; --rate states it",
                                     shape.roles.shown(*time_column_)));
    if (shape.rate > 0 && differ(shape.rate, scale_.rate))
      warnings.push_back(fmt::format("{} tells {:.6g} Hz, the stated rate of {} Hz is used",
                                     shape.roles.shown(*time_column_), scale_.rate, shape.rate));
    if (!(options_.rate > 0)) return;
    recording.frame_rate = options_.rate;
    if (differ(options_.rate, found))
      warnings.push_back(
          fmt::format("the file tells {:.6g} Hz, --rate {} is used", found, options_.rate));
  }

  // Whether two rates, if both are known, are more apart than printed times make them.
  static bool differ(double rate, double other) {
    return rate > 0 && other > 0 && std::abs(rate - other) > 0.02 * rate;
  }

  void notes(Recording& recording) const {
    const TableShape& shape = document_->shape;
    ReadingNotes& notes = recording.notes;
    notes.layout = shape.dialect.empty() ? "" : shape.dialect + ": ";
    notes.layout += shape.roles.described();
    if (!options_.columns.empty())
      notes.layout += ", as --columns says";
    else if (options_.layout != ColumnLayout::automatic)
      notes.layout += ", as --layout says";
    if (document_->uses_confidence) notes.layout += "; weighed by their confidences";
    if (time_column_) {
      notes.layout += fmt::format("; time in column {}", *time_column_ + 1);
      if (!scale_.unit.empty()) notes.layout += fmt::format(" in {}", scale_.unit);
    }
    if (recording.frame_rate > 0) notes.layout += fmt::format(", {:.6g} Hz", recording.frame_rate);
    for (std::size_t c = 0; c < shape.roles.roles.size(); ++c) {
      const ColumnRole role = shape.roles.roles[c];
      const bool is_sample = role == ColumnRole::coordinate || role == ColumnRole::plain;
      const bool is_nothing = c >= shape.least_cells && shape.roles.names[c].empty();
      if (!is_sample && !is_nothing) notes.passed_through.push_back(shape.roles.shown(c));
    }
    for (const std::string& part : shape.other_parts) notes.passed_through.push_back(part);
  }

  const std::filesystem::path& file_;
  const ReadOptions& options_;
  std::shared_ptr<TableDocument> document_;
  std::optional<std::size_t> time_column_;
  TimeScale scale_;
};

}  // namespace

Recording read_table(std::string_view content, const std::filesystem::path& file,
                     const ReadOptions& options, std::string_view extension) {
  return TableReader(content, file, options, extension).read();
}

const TableDocument* table_of(const Recording& recording, std::string_view extension) {
  const auto* const framed = std::any_cast<FramedSource>(&recording.source);
  const auto* const source = framed ? std::any_cast<TableSource>(&framed->file) : nullptr;
  if (!source) return nullptr;
  const TableDocument& document = *source->document;
  const bool fits = document.extension == extension && document.columns == recording.columns &&
                    document.shape.unit == recording.unit &&
                    framed->first + recording.frames() <= document.frames;
  return fits ? &document : nullptr;
}

}  // namespace moclean
