#include "moclean/formats/text_scanner.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/printable.hpp"

namespace moclean {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// std::from_chars knows no plus sign; "+-1" stays an error.
const char* skip_plus(const char* first, const char* last) {
  return first + 1 < last && first[0] == '+' && first[1] != '-' ? first + 1 : first;
}

bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }

// `1.#IND`, `-1.#QNAN00` and their like.
bool is_microsoft_nan(std::string_view word) {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  for (const std::string_view known : {"1.#IND", "1.#QNAN", "1.#SNAN"})
    if (word.starts_with(known)) return word.find_first_not_of('0', known.size()) == word.npos;
  return false;
}

// Whether a sign or a second point stands in a word where only the next number can have it.
bool is_glued(std::string_view word) {
  if (std::count(word.begin(), word.end(), '.') > 1 && is_decimal_digit(word.back())) return true;
  for (std::size_t i = 1; i < word.size(); ++i)
    if ((word[i] == '-' || word[i] == '+') && (is_decimal_digit(word[i - 1]) || word[i - 1] == '.'))
      return true;
  return false;
}

}  // namespace

std::string excerpt(std::string_view text) {
  constexpr std::size_t longest = 32;
  std::size_t length = std::min(longest, text.size());
  const auto is_within_character = [&] {
    return length < text.size() && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U;
  };
  for (int i = 0; i < 3 && is_within_character() && length > 0; ++i) --length;
  std::string shown = printable_line(text.substr(0, length));
  for (std::size_t end = shown.find('\n'); end != std::string::npos; end = shown.find('\n', end))
    shown.replace(end, 1, "\\x0A");
  return fmt::format("'{}{}'", shown, length < text.size() ? "..." : "");
}

TextScanner::TextScanner(std::string_view text, std::filesystem::path file, const Dialect& dialect)
    : file_(std::move(file)), position_(text.data()), end_(text.data() + text.size()) {
  if (text.starts_with("\xEF\xBB\xBF")) position_ += 3;
  assign(dialect.blanks, Kind::blank);
  assign("\r\n", Kind::line_end);
  assign(dialect.marks, Kind::mark);
  if (dialect.comment != '\0') assign({&dialect.comment, 1}, Kind::comment);
}

void TextScanner::assign(std::string_view characters, Kind kind) {
  for (const char c : characters) kinds_[static_cast<unsigned char>(c)] = kind;
}

void TextScanner::skip_to_line_end() {
  while (position_ != end_ && kind(*position_) != Kind::line_end) ++position_;
}

// Both are called where at_word() is false: before a comment, a line end, or the end.
bool TextScanner::at_end_of_line() {
  if (position_ != end_ && kind(*position_) == Kind::comment) skip_to_line_end();
  return true;
}

bool TextScanner::at_end_of_text() {
  while (at_line_end()) {
    if (position_ == end_) return true;
    next_line();
  }
  return false;
}

void TextScanner::next_line() {
  skip_to_line_end();
  if (position_ == end_) return;
  const bool carriage_return = *position_++ == '\r';
  if (carriage_return && position_ != end_ && *position_ == '\n') ++position_;
  ++line_;
}

std::string_view TextScanner::word() {
  if (at_end()) return {};
  const char* const first = position_++;
  if (kind(*first) == Kind::text)
    while (!is_word_end(position_)) ++position_;
  return {first, position_};
}

std::string_view TextScanner::text_before(char stop) {
  if (at_line_end()) return {};
  const char* const first = position_;
  while (position_ != end_ && *position_ != stop && kind(*position_) != Kind::line_end &&
         kind(*position_) != Kind::comment)
    ++position_;
  const char* last = position_;
  while (last != first && kind(last[-1]) == Kind::blank) --last;
  return {first, last};
}

bool TextScanner::accept(std::string_view keyword) {
  if (at_end() || bytes_left() < keyword.size()) return false;
  const bool same = std::equal(keyword.begin(), keyword.end(), position_,
                               [](char a, char b) { return lower(a) == lower(b); });
  const char* const after = position_ + keyword.size();
  const bool ends = keyword.ends_with(':') || kind(keyword.back()) == Kind::mark;
  if (!same || (!ends && !is_word_end(after))) return false;
  position_ = after;
  return true;
}

void TextScanner::expect(std::string_view keyword) {
  if (!accept(keyword)) fail_expected(keyword);
}

double TextScanner::number_or_nan() {
  if (at_end()) fail_expected("a number");
  double value = 0;
  const auto [after, error] = std::from_chars(skip_plus(position_, end_), end_, value);
  if (error != std::errc() || !is_word_end(after)) fail_expected("a number");
  position_ = after;
  return value;
}

double TextScanner::finite_number() {
  const char* const before = position_;
  const double value = number_or_nan();
  if (std::isfinite(value)) return value;
  position_ = before;
  fail_expected("a finite number");
}

// A word that plain_number() does not know.
bool TextScanner::accept_unusual_number(double& value) {
  const char* last = position_;
  while (!is_word_end(last)) ++last;
  const auto [after, error] = std::from_chars(skip_plus(position_, last), last, value);
  if (is_microsoft_nan({position_, last}))
    value = std::numeric_limits<double>::quiet_NaN();
  else if (error != std::errc() || after != last || last == position_ || std::isinf(value))
    return false;
  position_ = last;
  return true;
}

Index TextScanner::count() {
  if (at_end()) fail_expected("a whole number");
  Index value = 0;
  const auto [after, error] = std::from_chars(skip_plus(position_, end_), end_, value);
  if (error != std::errc() || !is_word_end(after) || value < 0) fail_expected("a whole number");
  position_ = after;
  return value;
}

void TextScanner::expect_line_end() {
  if (!at_line_end()) fail_expected("the end of the line");
}

void TextScanner::fail(const std::string& problem) const { throw FileError(file_, line_, problem); }

void TextScanner::fail_expected(std::string_view expected) {
  const std::string_view found = word();
  fail(fmt::format("expected {}, found {}", expected,
                   found.empty() ? "the end of the file" : excerpt(found)));
}

void TextScanner::fail_number() {
  const std::string_view found = word();
  if (found.empty()) fail_expected("a number");
  std::string problem = fmt::format("expected a number, found {}", excerpt(found));
  if (found.find(',') != found.npos)
    problem += "; numbers stand between blanks, decimals behind a point";
  else if (is_glued(found))
    problem += "; two numbers without a blank between them";
  fail(problem);
}

}  // namespace moclean
