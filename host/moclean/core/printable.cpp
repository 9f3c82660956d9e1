#include "moclean/core/printable.hpp"

#include <cstddef>
#include <cstdint>

namespace moclean {
namespace {

unsigned byte_at(std::string_view text, std::size_t place) {
  return static_cast<unsigned char>(text[place]);
}

// A character that begins a text: its bytes, 0 if none does, and its code.
struct Character {
  std::size_t length = 0;
  std::uint32_t code = 0;
};

// By RFC 3629, which refuses overlong forms, surrogates and what lies beyond U+10FFFF.
Character first_character(std::string_view text) {
  const unsigned first = byte_at(text, 0);
  if (first < 0x80) return {1, first};
  const std::size_t length = first < 0xC2   ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  if (length == 0 || text.size() < length) return {};
  std::uint32_t code = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte_at(text, i) & 0xC0U) != 0x80U) return {};
    code = code << 6 | (byte_at(text, i) & 0x3FU);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  if (code < least[length] || is_surrogate || code > 0x10FFFF) return {};
  return {length, code};
}

// Controls, C0 and C1, and what shows a text otherwise than it is: with a mark of direction
// `gpj.exe` reads `exe.jpg`. Joiners belong to the spelling of languages and stay.
bool controls(std::uint32_t code) {
  constexpr struct {
    std::uint32_t first, last;
  } ranges[] = {{0, 0x1F},        {0x7F, 0x9F},      {0x61C, 0x61C},   {0x200B, 0x200B},
                {0x200E, 0x200F}, {0x2028, 0x202E},  {0x2060, 0x206F}, {0xFEFF, 0xFEFF},
                {0xFFF9, 0xFFFB}, {0xE0000, 0xE007F}};
  for (const auto& [first, last] : ranges)
    if (code >= first && code <= last) return true;
  return false;
}

std::string shown(std::string_view text, bool keeps_lines) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const auto [length, code] = first_character(text);
    const std::string_view bytes = text.substr(0, length == 0 ? 1 : length);
    if (length > 0 && (!controls(code) || (code == '\n' && keeps_lines))) {
      shown += bytes;
    } else {
      for (std::size_t i = 0; i < bytes.size(); ++i)
        shown += {'\\', 'x', digits[byte_at(bytes, i) >> 4], digits[byte_at(bytes, i) & 15U]};
    }
    text.remove_prefix(bytes.size());
  }
  return shown;
}

}  // namespace

std::string printable(std::string_view text) { return shown(text, true); }

std::string printable_line(std::string_view text) { return shown(text, false); }

}  // namespace moclean
