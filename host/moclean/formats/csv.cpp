#include "moclean/formats/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/frame_rate.hpp"
#include "moclean/formats/row_collector.hpp"
#include "moclean/formats/text_scanner.hpp"
#include "moclean/formats/written_text.hpp"

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

// The names of a header line, and the separator between them.
struct Header {
  std::vector<std::string> names;
  char separator = ',';
};

char separator_of(std::string_view line) {
  for (const char candidate : {',', ';', '\t'}) {
    bool in_quotes = false;
    for (const char c : line) {
      if (c == '"') in_quotes = !in_quotes;
      if (c == candidate && !in_quotes) return candidate;
    }
  }
  return ',';
}

std::string name_of(std::string_view cell) {
  const std::size_t first = cell.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  cell = cell.substr(first, cell.find_last_not_of(" \t") - first + 1);
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string(cell);
  std::string name;
  cell = cell.substr(1, cell.size() - 2);
  for (std::size_t i = 0; i < cell.size(); ++i) {
    name += cell[i];
    if (cell.substr(i, 2) == "\"\"") ++i;
  }
  return name;
}

Header parse_header(std::string_view line) {
  Header header;
  header.separator = separator_of(line);
  bool in_quotes = false;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') in_quotes = !in_quotes;
    if (i < line.size() && (in_quotes || line[i] != header.separator)) continue;
    header.names.push_back(name_of(line.substr(first, i - first)));
    first = i + 1;
  }
  return header;
}

bool is_number(const std::string& text) {
  double value = 0;
  const auto [after, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && after == text.data() + text.size();
}

bool is_time(std::string name) {
  std::erase_if(name, [](char c) { return c == ' ' || c == '\t'; });
  std::transform(name.begin(), name.end(), name.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  for (const char* known : {"time", "t", "t(s)", "time(s)", "t[s]", "time[s]"})
    if (name == known) return true;
  return false;
}

// The mean of those steps that lie within a factor 1.5 of the median step: frames left out make few
// steps too long, and printed times make every step a little wrong, which the mean evens out.
double rate_of(const std::vector<double>& times) {
  if (times.size() < 2) return 0;
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double median = *middle;
  double sum = 0, count = 0;
  for (const double step : steps)
    if (step < 1.5 * median && median < 1.5 * step) {
      sum += step;
      ++count;
    }
  return rate_from_period(sum / count);
}

class CsvParser {
 public:
  CsvParser(std::string_view text, const std::filesystem::path& file)
      : scanner_(text, file, {.blanks = " "}) {}

  Recording parse() {
    comments();
    header();
    if (scanner_.at_end()) scanner_.fail_expected("a line of samples");
    RowCollector frames(static_cast<Index>(clip_.columns.size()));
    do row(frames.add(scanner_.bytes_left()));
    while (!scanner_.at_end());
    clip_.samples = frames.take();
    if (clip_.frame_rate == 0) clip_.frame_rate = rate_of(times_);
    return std::move(clip_);
  }

 private:
  void comments() {
    for (; scanner_.peek() == '#'; scanner_.next_line()) {
      const auto [name, value] = setting(scanner_.text_before('\0'));
      if (name == "unit") clip_.unit = value;
      if (name == "up") clip_.up = up_axis(value);
      if (name != "frame_rate") continue;
      const auto [after, error] =
          std::from_chars(value.data(), value.data() + value.size(), clip_.frame_rate);
      if (error != std::errc() || after != value.data() + value.size() ||
          !std::isfinite(clip_.frame_rate) || clip_.frame_rate < 0)
        scanner_.fail("expected a frame rate in Hz, found " + excerpt(value));
    }
  }

  void header() {
    if (scanner_.at_end()) scanner_.fail_expected("a line of column names");
    Header header = parse_header(scanner_.text_before('\0'));
    if (std::all_of(header.names.begin(), header.names.end(), is_number))
      scanner_.fail("expected a line of column names, found numbers");
    separator_ = header.separator;
    scanner_.add_marks({&separator_, 1});
    if (separator_ != '\t') scanner_.add_blanks("\t");
    scanner_.next_line();
    has_time_ = is_time(header.names.front());
    if (has_time_) header.names.erase(header.names.begin());
    if (header.names.empty()) scanner_.fail("expected columns beside the time");
    clip_.columns = std::move(header.names);
  }

  void row(double* samples) {
    if (has_time_) time();
    for (std::size_t c = 0; c < clip_.columns.size(); ++c) {
      if (c > 0 || has_time_) separator(c);
      samples[c] = sample();
    }
    if (!scanner_.at_line_end()) {
      if (scanner_.peek() != separator_) scanner_.fail_expected("the end of the line");
      scanner_.fail(fmt::format("expected {} columns, found more", width()));
    }
  }

  void time() {
    const double seconds = scanner_.number();
    if (!times_.empty() && !(seconds > times_.back()))
      scanner_.fail(fmt::format("expected a time after {}, found {}", times_.back(), seconds));
    times_.push_back(seconds);
  }

  void separator(std::size_t column) {
    if (scanner_.at_line_end())
      scanner_.fail(
          fmt::format("expected {} columns, found {}", width(), column + (has_time_ ? 1 : 0)));
    if (!scanner_.accept({&separator_, 1})) scanner_.fail_expected("a separator");
  }

  double sample() {
    if (scanner_.at_line_end() || scanner_.peek() == separator_)
      return std::numeric_limits<double>::quiet_NaN();
    return scanner_.number_or_nan();
  }

  // Columns of the file, the time included.
  std::size_t width() const { return clip_.columns.size() + (has_time_ ? 1 : 0); }

  TextScanner scanner_;
  Recording clip_;
  char separator_ = ',';
  bool has_time_ = false;
  std::vector<double> times_;
};

std::string header_cell(const std::string& name) {
  if (name.find_first_of(",;\t\"#") == std::string::npos && !name.starts_with(' ') &&
      !name.ends_with(' '))
    return name;
  std::string cell;
  for (const char c : name) cell.append(c == '"' ? 2 : 1, c);
  return fmt::format("\"{}\"", cell);
}

std::string head(const Recording& clip) {
  std::string text;
  if (clip.frame_rate > 0) text += fmt::format("# frame_rate: {}\n", clip.frame_rate);
  if (!clip.unit.empty()) text += fmt::format("# unit: {}\n", clip.unit);
  if (clip.up) text += fmt::format("# up: {}\n", "xyz"[static_cast<int>(*clip.up)]);
  for (std::size_t c = 0; c < clip.columns.size(); ++c) {
    if (c > 0) text += ',';
    text += header_cell(clip.columns[c]);
  }
  return text + "\n";
}

constexpr std::size_t longest_number = 24;  // characters of the longest shortest text of a double

char* put_number(char* position, double value) {
  if (std::isnan(value)) return std::copy_n("nan", 3, position);
  return std::to_chars(position, position + longest_number, value).ptr;
}

Recording read_csv(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions&) {
  return parse_csv(content, file);
}

}  // namespace

Recording parse_csv(std::string_view text, const std::filesystem::path& file) {
  return CsvParser(text, file).parse();
}

void write_csv(AtomicFile& file, const Recording& clip) {
  for (const std::string& name : clip.columns)
    if (name.find_first_of("\r\n") != std::string::npos)
      throw FileError(file.target(), "cannot be written: the column name " + excerpt(name) +
                                         " holds a line break");
  file.write(head(clip));
  const Index columns = clip.samples.cols();
  std::vector<char> text(text_chunk + static_cast<std::size_t>(columns) * (longest_number + 1) + 1);
  char* end = text.data();
  const auto flush = [&] {
    file.write({text.data(), static_cast<std::size_t>(end - text.data())});
    end = text.data();
  };
  for (Index f = 0; f < clip.frames(); ++f) {
    for (Index c = 0; c < columns; ++c) {
      if (c > 0) *end++ = ',';
      end = put_number(end, clip.samples(f, c));
    }
    *end++ = '\n';
    if (end - text.data() >= static_cast<std::ptrdiff_t>(text_chunk)) flush();
  }
  flush();
}

constinit const Format csv_format = {
    .name = "CSV",
    .extension = ".csv",
    .notes =
        "a header of column names, `# frame_rate: HZ` or a time column; empty or `nan` is a "
        "missing sample",
    .content = {.names = true, .frame_rate = true, .unit = true, .up = true, .gaps = true},
    .read = read_csv,
    .write = write_csv,
};

}  // namespace moclean
