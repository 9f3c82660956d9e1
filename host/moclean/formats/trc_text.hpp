#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string_view>

#include "moclean/formats/plain_number.hpp"
#include "moclean/formats/text_lines.hpp"

namespace moclean {

/// The cells of a line: what stands between tabs, without blanks around it, or words where a line
/// has no tab.
class TrcCells {
 public:
  explicit TrcCells(std::string_view line)
      : position_(line.data()),
        end_(line.data() + line.size()),
        has_tabs_(line.find('\t') != std::string_view::npos) {
    if (!has_tabs_) skip_blanks();
    at_end_ = position_ == end_;
  }

  bool has_tabs() const { return has_tabs_; }

  /// Moves to the next cell, which may be empty between tabs; false behind the last one.
  bool next() {
    if (at_end_) return false;
    const char* const first = position_;
    if (has_tabs_) {
      const auto* const tab = static_cast<const char*>(
          std::memchr(position_, '\t', static_cast<std::size_t>(end_ - position_)));
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
  bool has_tabs_, at_end_ = false;
  std::string_view cell_;
};

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
