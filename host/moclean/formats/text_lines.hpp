#pragma once

#include <cstddef>
#include <cstring>
#include <string_view>

namespace moclean {

/// The lines of a text, one after the other, without their ends (LF, CR LF, or CR in a text
/// that has no LF).
class TextLines {
 public:
  /// From the byte `position` on, which begins line `number`.
  explicit TextLines(std::string_view text, std::size_t position = 0, std::size_t number = 1)
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

}  // namespace moclean
