#include "moclean/formats/new_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/table_number.hpp"
#include "moclean/formats/text_scanner.hpp"
#include "moclean/formats/written_text.hpp"

namespace moclean {
namespace {

// A spreadsheet takes a cell that begins so for a formula.
bool would_be_executed(const std::string& name) {
  double value = 0;
  return !name.empty() && std::string_view("=+-@").find(name[0]) != std::string_view::npos &&
         !table_number(name, '.', value);
}

// A line of nothing else is a row of samples to every reader.
bool is_number_or_missing(const std::string& name) {
  double value = 0;
  return table_number(name, '.', value) || table_number(name, ',', value) || says_missing(name);
}

std::string header_cell(const std::string& name, bool are_numbers) {
  const bool has_mark = would_be_executed(name) || (are_numbers && !says_missing(name));
  if (!has_mark && name.find_first_of(",;\t\"#'") == std::string::npos && !name.starts_with(' ') &&
      !name.ends_with(' '))
    return name;
  std::string cell = has_mark ? "'" : "";
  for (const char c : name) cell.append(c == '"' ? 2 : 1, c);
  return fmt::format("\"{}\"", cell);
}

std::string new_table_head(const Recording& clip, char separator) {
  std::string text;
  if (clip.frame_rate > 0) text += fmt::format("# frame_rate: {}\n", clip.frame_rate);
  if (!clip.unit.empty()) text += fmt::format("# unit: {}\n", clip.unit);
  if (clip.up) text += fmt::format("# up: {}\n", "xyz"[static_cast<int>(*clip.up)]);
  const bool are_numbers = std::ranges::all_of(clip.columns, is_number_or_missing);
  for (std::size_t c = 0; c < clip.columns.size(); ++c) {
    if (c > 0) text += separator;
    text += header_cell(clip.columns[c], are_numbers);
  }
  return text + "\n";
}

constexpr std::size_t longest_number = 24;  // characters of the longest shortest text of a double

char* put_number(char* position, double value) {
  if (std::isnan(value)) return std::copy_n("nan", 3, position);
  return std::to_chars(position, position + longest_number, value).ptr;
}

}  // namespace

void write_new_table(AtomicFile& file, const Recording& clip, char separator) {
  for (const std::string& name : clip.columns)
    if (name.find_first_of("\r\n") != std::string::npos)
      throw FileError(file.target(), "cannot be written: the column name " + excerpt(name) +
                                         " holds a line break");
  file.write(new_table_head(clip, separator));
  const Index columns = clip.samples.cols();
  std::vector<char> text(text_chunk + static_cast<std::size_t>(columns) * (longest_number + 1) + 1);
  char* end = text.data();
  const auto flush = [&] {
    file.write({text.data(), static_cast<std::size_t>(end - text.data())});
    end = text.data();
  };
  for (Index f = 0; f < clip.frames(); ++f) {
    for (Index c = 0; c < columns; ++c) {
      if (c > 0) *end++ = separator;
      end = put_number(end, clip.samples(f, c));
    }
    *end++ = '\n';
    if (end - text.data() >= static_cast<std::ptrdiff_t>(text_chunk)) flush();
  }
  flush();
}

}  // namespace moclean
