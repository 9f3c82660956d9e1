#include "moclean/formats/text_encoding.hpp"

namespace moclean {
namespace {

std::uint32_t unit_at(std::string_view bytes, std::size_t place, bool is_little) {
  const std::uint32_t first = static_cast<unsigned char>(bytes[place]);
  const std::uint32_t second = static_cast<unsigned char>(bytes[place + 1]);
  return is_little ? first | second << 8U : second | first << 8U;
}

char byte_of(std::uint32_t bits) { return static_cast<char>(bits & 0xFFU); }

std::string utf8_of(std::string_view bytes, bool is_little) {
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit_at(bytes, i, is_little);
    if (code >> 10U == 0x36U && i + 3 < bytes.size()) {  // the first half of a surrogate pair
      const std::uint32_t low = unit_at(bytes, i + 2, is_little);
      if (low >> 10U == 0x37U) {
        code = 0x10000U + ((code & 0x3FFU) << 10U | (low & 0x3FFU));
        i += 2;
      }
    }
    put_utf8(code, text);
  }
  return text;
}

// Bytes of a character by its first one; of invalid text, 1.
std::size_t length_of(unsigned char first) {
  return first < 0xC0U ? 1 : first < 0xE0U ? 2 : first < 0xF0U ? 3 : 4;
}

}  // namespace

void put_utf8(std::uint32_t code, std::string& text) {
  if (code < 0x80U) {
    text += byte_of(code);
    return;
  }
  if (code < 0x800U) {
    text += byte_of(0xC0U | code >> 6U);
  } else {
    if (code < 0x10000U) {
      text += byte_of(0xE0U | code >> 12U);
    } else {
      text += byte_of(0xF0U | code >> 18U);
      text += byte_of(0x80U | (code >> 12U & 0x3FU));
    }
    text += byte_of(0x80U | (code >> 6U & 0x3FU));
  }
  text += byte_of(0x80U | (code & 0x3FU));
}

std::uint32_t take_utf8(std::string_view text, std::size_t& place) {
  const auto first = static_cast<unsigned char>(text[place]);
  std::size_t length = length_of(first);
  if (place + length > text.size()) length = 1;
  std::uint32_t code = length == 1 ? first : first & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k)
    code = code << 6U | (static_cast<unsigned char>(text[place + k]) & 0x3FU);
  place += length;
  return code;
}

std::string_view byte_order_mark(TextEncoding encoding) {
  switch (encoding) {
    case TextEncoding::utf16_little_endian:
      return "\xFF\xFE";
    case TextEncoding::utf16_big_endian:
      return "\xFE\xFF";
    default:
      return "\xEF\xBB\xBF";
  }
}

DecodedText decoded(std::string_view bytes, bool& has_half_character) {
  has_half_character = false;
  for (const auto encoding :
       {TextEncoding::utf8, TextEncoding::utf16_little_endian, TextEncoding::utf16_big_endian}) {
    const std::string_view mark = byte_order_mark(encoding);
    const bool has_mark = bytes.starts_with(mark);
    const bool is_little = encoding == TextEncoding::utf16_little_endian;
    const std::size_t zero = is_little ? 1 : 0;  // the empty half of an ASCII character
    const auto is_ascii = [&](std::size_t place) {
      return bytes[place + zero] == 0 && bytes[place + 1 - zero] > 0;
    };
    const bool looks_so =
        encoding != TextEncoding::utf8 && bytes.size() >= 4 && is_ascii(0) && is_ascii(2);
    if (!has_mark && !looks_so) continue;
    const std::string_view rest = bytes.substr(has_mark ? mark.size() : 0);
    if (encoding == TextEncoding::utf8) return {std::string(rest), encoding, true};
    has_half_character = rest.size() % 2 != 0;
    return {utf8_of(rest, is_little), encoding, has_mark};
  }
  return {std::string(bytes), TextEncoding::utf8, false};
}

std::string encoded(std::string_view text, TextEncoding encoding) {
  if (encoding == TextEncoding::utf8) return std::string(text);
  const bool is_little = encoding == TextEncoding::utf16_little_endian;
  std::string bytes;
  bytes.reserve(2 * text.size());
  const auto put = [&](std::uint32_t unit) {
    bytes += byte_of(is_little ? unit : unit >> 8U);
    bytes += byte_of(is_little ? unit >> 8U : unit);
  };
  for (std::size_t i = 0; i < text.size();) {
    const std::uint32_t code = take_utf8(text, i);
    if (code < 0x10000U) {
      put(code);
    } else {
      put(0xD800U | (code - 0x10000U) >> 10U);
      put(0xDC00U | ((code - 0x10000U) & 0x3FFU));
    }
  }
  return bytes;
}

}  // namespace moclean
