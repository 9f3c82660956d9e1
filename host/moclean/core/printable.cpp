#include "moclean/core/printable.hpp"

#include <cstddef>
#include <cstdint>

namespace moclean {
namespace {

unsigned byte_at(std::string_view text, std::size_t place) {
  return static_cast<unsigned char>(text[place]);
}

// Bytes of the UTF-8 character that begins a text, 0 if none does: RFC 3629, which refuses overlong
// forms, surrogates and what lies beyond U+10FFFF.
std::size_t length_of_character(std::string_view text) {
  const unsigned first = byte_at(text, 0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xC2   ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  if (length == 0 || text.size() < length) return 0;
  std::uint32_t code = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte_at(text, i) & 0xC0U) != 0x80U) return 0;
    code = code << 6 | (byte_at(text, i) & 0x3FU);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  return code < least[length] || is_surrogate || code > 0x10FFFF ? 0 : length;
}

bool controls(std::string_view character) {
  const unsigned first = byte_at(character, 0);
  if (character.size() == 1) return (first < 0x20 && first != '\n') || first == 0x7F;
  return character.size() == 2 && first == 0xC2 && byte_at(character, 1) < 0xA0;  // C1
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = length_of_character(text);
    const std::string_view character = text.substr(0, length == 0 ? 1 : length);
    if (length > 0 && !controls(character)) {
      shown += character;
    } else {
      for (std::size_t i = 0; i < character.size(); ++i) {
        const unsigned byte = byte_at(character, i);
        shown += {'\\', 'x', digits[byte >> 4], digits[byte & 15U]};
      }
    }
    text.remove_prefix(character.size());
  }
  return shown;
}

}  // namespace moclean
