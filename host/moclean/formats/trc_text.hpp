#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

#include "moclean/formats/plain_number.hpp"
#include "moclean/formats/text_lines.hpp"

namespace moclean {

/// The cells of a line: what stands between tabs, without blanks around it; between commas where
/// there is no tab and the first cell ends with one (spreadsheets write it so); else words.
class TrcCells {
 public:
  explicit TrcCells(std::string_view line)
      : position_(line.data()), end_(line.data() + line.size()), separator_(separator_of(line)) {
    if (!has_tabs()) skip_blanks();
    at_end_ = position_ == end_;
  }

  bool has_tabs() const { return separator_ != ' '; }  ///< or commas
  char separator() const { return separator_; }        ///< a tab, a comma or a blank

  /// Moves to the next cell, which may be empty between tabs; false behind the last one.
  bool next() {
    if (at_end_) return false;
    const char* const first = position_;
    if (has_tabs()) {
      const auto* const tab = static_cast<const char*>(
          std::memchr(position_, separator_, static_cast<std::size_t>(end_ - position_)));
      const char* const last = tab ? tab : end_;
      at_end_ = tab == nullptr;
      position_ = tab ? tab + 1 : end_;
      cell_ = trimmed(first, last);
    } else {
      while (position_ != end_ && *position_ != ' ') ++position_;
      cell_ = {first, position_};
      skip_blanks();
      at_end_ = position_ == end_;
    }
    return true;
  }

  std::string_view cell() const { return cell_; }

 private:
  static char separator_of(std::string_view line) {
    if (line.find('\t') != std::string_view::npos) return '\t';
    const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t comma = line.find(',', first);
    return comma != std::string_view::npos && comma < line.find(' ', first) ? ',' : ' ';
  }

  void skip_blanks() {
    while (position_ != end_ && *position_ == ' ') ++position_;
  }

  static std::string_view trimmed(const char* first, const char* last) {
    while (first != last && *first == ' ') ++first;
    while (first != last && last[-1] == ' ') --last;
    return {first, last};
  }

  const char* position_;
  const char* end_;
  char separator_;
  bool at_end_ = false;
  std::string_view cell_;
};

/// Whether a line has nothing but separators.
inline bool is_trc_blank(std::string_view line) {
  return line.find_first_not_of(" \t,") == std::string_view::npos;
}

/// The cells of a line, without empty ones at its end.
inline std::vector<std::string_view> trc_cells(std::string_view line) {
  std::vector<std::string_view> found;
  for (TrcCells cells(line); cells.next();) found.push_back(cells.cell());
  while (!found.empty() && found.back().empty()) found.pop_back();
  return found;
}

/// The values under `count` names of settings. Motion Analysis has put two tabs between them: where
/// there are more cells than names, and not more values, empty cells are none.
inline std::vector<std::string_view> trc_settings(std::string_view line, std::size_t count) {
  std::vector<std::string_view> values = trc_cells(line), all = values;
  std::erase_if(values, [](std::string_view cell) { return cell.empty(); });
  return all.size() > count && values.size() <= count ? values : all;
}

/// A cell as a sample: NaN where it is empty or says so. False if it is no finite number.
inline bool trc_sample(std::string_view cell, double& value) {
  value = std::numeric_limits<double>::quiet_NaN();
  if (cell.empty()) return true;
  const char* const last = cell.data() + cell.size();
  if (plain_number(cell.data(), last, value) == last) return true;
  if (cell.front() == '+' && !cell.starts_with("+-")) cell.remove_prefix(1);
  const auto [after, error] = std::from_chars(cell.data(), last, value);
  return error == std::errc() && after == last && !std::isinf(value);
}

}  // namespace moclean
