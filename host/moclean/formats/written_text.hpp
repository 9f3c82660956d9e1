#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "moclean/formats/file.hpp"

namespace moclean {

/// Bytes of text that writers make before they write it: it stays in the cache in between.
inline constexpr std::size_t text_chunk = 1 << 18;

/// Writes and empties a text that has become as long as that.
inline void write_if_full(AtomicFile& file, std::string& text) {
  if (text.size() < text_chunk) return;
  file.write(text);
  text.clear();
}

/// Digits behind the point of a number as a file spells it; nothing if it has no point.
inline std::optional<std::size_t> decimals_of(std::string_view number) {
  const std::size_t point = number.find('.');
  if (point == std::string_view::npos) return std::nullopt;
  const std::string_view digits = number.substr(point + 1);
  return std::min(digits.find_first_not_of("0123456789"), digits.size());
}

}  // namespace moclean
