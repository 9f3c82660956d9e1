#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include "moclean/formats/plain_number.hpp"
#include "moclean/formats/written_text.hpp"

namespace moclean {

/// The number that a word of a file of channels spells, with a decimal point or comma; NaN where it
/// is none.
inline double channel_number(std::string_view word) {
  std::string with_point;
  if (const std::size_t comma = word.find(','); comma != word.npos) {
    with_point = word;
    with_point[comma] = '.';
    word = with_point;
  }
  const bool has_plus = word.starts_with('+');
  const char *const first = word.data() + has_plus, *const last = word.data() + word.size();
  double value = 0;
  if (plain_number(first, last, value) == last) return value;
  const auto [after, error] = std::from_chars(first, last, value);
  return error == std::errc() && after == last ? value : std::numeric_limits<double>::quiet_NaN();
}

/// How changed numbers of a file of channels are spelt.
struct ChannelSpelling {
  int decimals = 4;  ///< fewer would not keep angles and places of a body to 1e-5 of its size
  bool has_comma = false;

  /// Takes note of a number that the file has: as many decimals as the longest, up to 12.
  void learn(std::string_view word) {
    constexpr int most = 12;
    std::string with_point(word);
    std::replace(with_point.begin(), with_point.end(), ',', '.');
    const auto own = static_cast<int>(decimals_of(with_point).value_or(0));
    decimals = std::max(decimals, std::min(own, most));
    has_comma |= word.find(',') != word.npos;
  }

  /// Appends a number, `nan` where it is none.
  void put(double value, std::string& text) const {
    if (std::isnan(value)) {
      text += "nan";
      return;
    }
    if (std::abs(value) < 0.5 * std::pow(10., -decimals)) value = 0;  // not -0.0000
    std::array<char, 400> digits;  // 1.8e308 has 309 before the point
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                   std::chars_format::fixed, decimals);
    const std::size_t before = text.size();
    text.append(digits.data(), end.ptr);
    if (has_comma) std::replace(text.begin() + static_cast<long>(before), text.end(), '.', ',');
  }
};

}  // namespace moclean
