#pragma once

#include <cstring>
#include <string>
#include <string_view>

namespace moclean {

/// Separator of tables whose cells are words, with any blanks and tabs between them.
inline constexpr char between_words = ' ';

/// Separators of tables whose cells hold vectors, as OpenSim writes them: a tab between cells and a
/// comma or colon between the components, each of which counts as a cell.
inline constexpr char between_components = '\x01', between_colon_components = '\x02';

/// The separator as it stands in the text between cells that are no components.
inline char separator_in_text(char separator) {
  const bool is_of_vectors =
      separator == between_components || separator == between_colon_components;
  return is_of_vectors ? '\t' : separator;
}

/// The cells of a line of a table, one after the other.
///
/// A cell may stand in double quotes, in which a doubled quote is one (RFC 4180); blanks around it
/// are no part of it. Where words are separated (between_words), blanks before the first and behind
/// the last word make no cell.
class TableCells {
 public:
  TableCells(std::string_view line, char separator)
      : position_(line.data()),
        end_(line.data() + line.size()),
        separator_(separator_in_text(separator)),
        inner_(separator == between_components         ? ','
               : separator == between_colon_components ? ':'
                                                       : separator_) {
    if (separator_ == between_words) {
      while (position_ != end_ && is_blank(*position_)) ++position_;
      at_end_ = position_ == end_;
    }
  }

  /// Moves to the next cell; false behind the last one. A line has one at least, which may be
  /// empty.
  bool next() {
    if (at_end_) return false;
    begin_ = position_;
    while (position_ != end_ && is_blank(*position_)) ++position_;
    is_quoted_ = position_ != end_ && *position_ == '"';
    const bool is_closed = is_quoted_ && skip_quoted();
    const char* const tail = position_;
    while (position_ != end_ && !separates(*position_)) ++position_;
    raw_end_ = position_;
    is_quoted_ = is_closed && take_quoted(tail);
    if (!is_quoted_) text_ = trimmed(begin_, raw_end_);
    step();
    return true;
  }

  std::string_view text() const { return text_; }  ///< without quotes; doubled ones stay doubled
  bool is_quoted() const { return is_quoted_; }
  const char* after() const { return raw_end_; }  ///< the end of the cell: a separator, or the end

  /// The cell with its quotes, without the blanks around it; of an empty one, where it stands.
  std::string_view raw() const {
    return is_quoted_ ? std::string_view(text_.data() - 1, text_.size() + 2) : text_;
  }

 private:
  bool is_blank(char c) const { return c == ' ' || (c == '\t' && separator_ != '\t'); }
  bool separates(char c) const {
    return separator_ == between_words ? is_blank(c) : c == separator_ || c == inner_;
  }

  // Moves behind the closing quote; false if there is none.
  bool skip_quoted() {
    const char* place = position_ + 1;
    while (true) {
      place =
          static_cast<const char*>(std::memchr(place, '"', static_cast<std::size_t>(end_ - place)));
      if (!place) return false;
      if (place + 1 == end_ || place[1] != '"') break;
      place += 2;
    }
    position_ = place + 1;
    return true;
  }

  // Quotes count only where they enclose all of the cell.
  bool take_quoted(const char* tail) {
    const std::string_view cell = trimmed(begin_, raw_end_);
    if (cell.data() + cell.size() > tail) return false;
    text_ = cell.substr(1, cell.size() - 2);
    return true;
  }

  std::string_view trimmed(const char* first, const char* last) const {
    while (first != last && is_blank(*first)) ++first;
    while (first != last && is_blank(last[-1])) --last;
    return {first, static_cast<std::size_t>(last - first)};
  }

  void step() {
    if (separator_ == between_words) {
      while (position_ != end_ && is_blank(*position_)) ++position_;
      at_end_ = position_ == end_;
      return;
    }
    at_end_ = position_ == end_;
    if (!at_end_) ++position_;
  }

  const char* position_;
  const char* end_;
  const char* begin_ = nullptr;
  const char* raw_end_ = nullptr;
  char separator_, inner_;  // of components; the same where there are none
  bool at_end_ = false, is_quoted_ = false;
  std::string_view text_;
};

/// A cell as a name: quotes that are doubled are one.
inline std::string unquoted(const TableCells& cells) {
  const std::string_view text = cells.text();
  if (!cells.is_quoted()) return std::string(text);
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    name += text[i];
    if (text[i] == '"' && i + 1 < text.size() && text[i + 1] == '"') ++i;
  }
  return name;
}

}  // namespace moclean
