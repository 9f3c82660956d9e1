#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace moclean {

/// How the characters of a text file are stored.
enum class TextEncoding { utf8, utf16_little_endian, utf16_big_endian };

/// A text in UTF-8, and how its file stores it.
struct DecodedText {
  std::string text;  ///< without a byte order mark
  TextEncoding encoding = TextEncoding::utf8;
  bool has_mark = false;  ///< begins with a byte order mark
};

/// Takes a file for UTF-16 if it begins with a byte order mark of it (as Excel's "Unicode text"
/// does), or with two characters of ASCII stored so; any other is left as it is. Half a surrogate
/// pair becomes the three bytes that UTF-8 would have for it, so that encoded() gives it back.
/// Sets `has_half_character` if a byte is left over at the end, which is dropped.
DecodedText decoded(std::string_view bytes, bool& has_half_character);

/// A part of a text, cut at a character's end, as its file stores it, without a mark.
std::string encoded(std::string_view text, TextEncoding encoding);

/// Appends a character to a text in UTF-8.
void put_utf8(std::uint32_t code, std::string& text);

/// The character at `place` of a text in UTF-8, which is moved behind it; where it is cut off or is
/// none, its first byte.
std::uint32_t take_utf8(std::string_view text, std::size_t& place);

/// The byte order mark.
std::string_view byte_order_mark(TextEncoding encoding);

}  // namespace moclean
