#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string_view>

#include "moclean/formats/plain_number.hpp"

namespace moclean {

/// The lines of a TRC text, one after the other, without their ends (LF, CR LF, or CR in a text
/// that has no LF).
class TrcLines {
 public:
  /// From the byte `position` on, which begins line `number`.
  explicit TrcLines(std::string_view text, std::size_t position = 0, std::size_t number = 1)
      : text_(text),
        position_(position),
        number_(number - 1),
        end_(text.find('\n') == std::string_view::npos ? '\r' : '\n') {}

  /// Moves to the next line; false behind the last one.
  bool next() {
    if (position_ >= text_.size()) return false;
    begin_ = position_;
    const void* const end = std::memchr(text_.data() + begin_, end_, text_.size() - begin_);
    ends_ = end != nullptr;
    const std::size_t length =
        ends_ ? static_cast<std::size_t>(static_cast<const char*>(end) - text_.data()) - begin_
              : text_.size() - begin_;
    position_ = begin_ + length + (ends_ ? 1 : 0);
    line_ = text_.substr(begin_, length);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    ++number_;
    return true;
  }

  std::string_view line() const { return line_; }
  bool is_blank() const { return line_.find_first_not_of(" \t") == std::string_view::npos; }
  bool has_end() const { return ends_; }              ///< false for a last line that was cut off
  std::size_t number() const { return number_; }      ///< counts from 1
  std::size_t begin() const { return begin_; }        ///< in bytes
  std::size_t position() const { return position_; }  ///< where the next line begins, in bytes
  std::size_t bytes_left() const { return text_.size() - position_; }

 private:
  std::string_view text_, line_;
  std::size_t position_, number_, begin_ = 0;
  char end_;
  bool ends_ = false;
};

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
