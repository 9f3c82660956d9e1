#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "moclean/core/matrix.hpp"
#include "moclean/formats/plain_number.hpp"

namespace moclean {

/// A piece of file content for an error message: in quotes, shortened, control bytes and what is no
/// UTF-8 as \xNN.
std::string excerpt(std::string_view text);

/// Walks through the words and numbers of a text and knows in which line it is.
///
/// Works on the whole file in memory and copies nothing, so that reading runs at the speed of
/// plain_number(). A UTF-8 byte order mark is skipped; LF, CR LF and CR end a line.
class TextScanner {
 public:
  /// How a format spells its text.
  struct Dialect {
    std::string_view blanks = " \t";
    std::string_view marks = "";  ///< characters that are a word of their own
    char comment = '\0';          ///< starts a comment up to the end of the line
  };

  /// `text` has to outlive the scanner; `file` is for messages.
  TextScanner(std::string_view text, std::filesystem::path file, const Dialect& dialect);

  /// Declares further blanks or marks, for a format that says so in its first lines.
  void add_blanks(std::string_view characters) { assign(characters, Kind::blank); }
  void add_marks(std::string_view characters) { assign(characters, Kind::mark); }

  /// Skips blanks and line ends; true if nothing else is left.
  bool at_end() { return !at_word() && at_end_of_text(); }

  /// Skips blanks; true if the line ends here (or the text does).
  bool at_line_end() { return !at_word() && at_end_of_line(); }

  /// Skips the rest of the line.
  void next_line();

  /// The next character that is not blank, on this line or a later one; '\0' at the end.
  char peek() { return at_end() ? '\0' : *position_; }

  /// The next word, on this line or a later one; empty at the end.
  std::string_view word();

  /// The rest of the line up to `stop`, which is not consumed, without blanks at either end.
  std::string_view text_before(char stop);

  /// Consumes the keyword if it comes next; upper and lower case are the same. A keyword that ends
  /// with ':' may be followed by anything, others by the end of the word.
  bool accept(std::string_view keyword);

  /// As accept(), but throws FileError when something else comes.
  void expect(std::string_view keyword);

  /// The next word as a finite number. Throws FileError naming what came instead.
  double number() {
    if (at_end()) fail_expected("a number");
    double value = 0;
    const char* const after = plain_number(position_, end_, value);
    if (!after || !is_word_end(after)) return finite_number();
    position_ = after;
    return value;
  }

  /// The next word as a number, NaN and infinity included.
  double number_or_nan();

  /// Consumes the next word of the line if it is a finite number, or says that there is none:
  /// `nan`, and what Microsoft's runtimes print for it (`-1.#IND00`, `1.#QNAN`), which is NaN.
  bool accept_number(double& value) {
    if (at_line_end()) return false;
    const char* const after = plain_number(position_, end_, value);
    if (!after || !is_word_end(after)) return accept_unusual_number(value);
    position_ = after;
    return true;
  }

  /// The next word as a whole number >= 0.
  Index count();

  /// Throws FileError unless the line ends here.
  void expect_line_end();

  /// Throws FileError at the current line.
  [[noreturn]] void fail(const std::string& problem) const;

  /// Throws FileError `expected ..., found '...'` with the next word.
  [[noreturn]] void fail_expected(std::string_view expected);

  /// As fail_expected("a number"), with the likely reason where there is one: a decimal comma, two
  /// numbers without a blank between them.
  [[noreturn]] void fail_number();

  std::size_t line() const { return line_; }  ///< counts from 1
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - position_); }

 private:
  enum class Kind : char { text, blank, line_end, mark, comment };
  Kind kind(char c) const { return kinds_[static_cast<unsigned char>(c)]; }
  bool is_word_end(const char* position) const {
    if (position == end_) return true;
    const Kind own = kind(*position);
    return own != Kind::text && !(own == Kind::comment && is_in_nan(position));
  }
  // Whether a `#` that is no comment stands here, behind something else: that of `-1.#IND`.
  bool is_in_nan(const char* position) const {
    return position[-1] == '.' && end_ - position > 1 &&
           (position[1] == 'I' || position[1] == 'Q' || position[1] == 'S');
  }
  void assign(std::string_view characters, Kind kind);
  void skip_to_line_end();

  // Skips blanks; true before a word or a mark: what nearly every call finds, so it is inline.
  bool at_word() {
    while (position_ != end_ && kind(*position_) == Kind::blank) ++position_;
    return position_ != end_ && (kind(*position_) == Kind::text || kind(*position_) == Kind::mark);
  }
  bool at_end_of_line();
  bool at_end_of_text();
  double finite_number();
  bool accept_unusual_number(double& value);

  std::filesystem::path file_;
  const char* position_;
  const char* end_;
  std::size_t line_ = 1;
  std::array<Kind, 256> kinds_{};
};

}  // namespace moclean
